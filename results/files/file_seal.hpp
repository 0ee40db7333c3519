#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace mpm {

/// The bytes that a seal takes at the end of a file: one line of text, the SHA-256 of all before it,
///
///   "\nmpmbench sha256 " + 64 hexadecimal digits + "\n"
///
/// HDF5 keeps the length of its data in the file and passes over what follows, so that all programs that read
/// HDF5 read a sealed file too; a program that changes it cuts the seal off. The library itself notices
/// damage in few places only, reads it as numbers in most, and crashes on some: hence the seal is checked
/// before the library sees a byte.
inline constexpr std::size_t kSealBytes = 82;

/// `content` with its seal.
std::vector<std::byte> sealed(std::vector<std::byte> content);

/// Puts the seal at the end of a file. Throws ArchiveError when it cannot be read or written.
void seal_file(const std::filesystem::path& path);

/// The content of a sealed file that was read as a whole, without the seal; none when it has no seal or the
/// seal is that of another content.
std::optional<std::string_view> unsealed(std::string_view file);

/// The content of a sealed file, without the seal.
///
/// Errors: ArchiveError for a file that cannot be read, has no seal (it is cut off, was changed by another
/// program, comes from an early version, or is no archive at all), or differs from what was sealed.
std::vector<std::byte> read_sealed_file(const std::filesystem::path& path);

/// The same without its content: throws unless it is what was sealed.
void require_seal(const std::filesystem::path& path);

}  // namespace mpm
