#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace mpm {

/// The length of the seal at the end of a file: one line of text with the SHA-256 of all bytes before it,
///
///   "\nmpmbench sha256 " + 64 hexadecimal digits + "\n"
///
/// HDF5 stores the length of its data in the file and ignores whatever follows. So all programs that read
/// HDF5 also read a sealed file; a program that changes the file cuts off the seal. The library itself
/// notices damage in few places only: in most it reads the damage as numbers, and in some it crashes.
/// Therefore the seal is checked before the library sees a byte.
inline constexpr std::size_t kSealBytes = 82;

/// Returns `content` with its seal.
std::vector<std::byte> sealed(std::vector<std::byte> content);

/// Appends the seal to a file. Throws ArchiveError if the file cannot be read or written.
void seal_file(const std::filesystem::path& path);

/// Returns the content of a sealed file that was read as a whole, without the seal; none if there is no seal
/// or the seal belongs to another content.
std::optional<std::string_view> unsealed(std::string_view file);

/// Reads a sealed file and returns its content, without the seal.
///
/// Errors: ArchiveError if the file cannot be read, has no seal (it is cut off, was changed by another
/// program, comes from an early version, or is no archive at all), or differs from what was sealed.
std::vector<std::byte> read_sealed_file(const std::filesystem::path& path);

/// Checks the seal without returning the content; errors as read_sealed_file().
void require_seal(const std::filesystem::path& path);

}  // namespace mpm
