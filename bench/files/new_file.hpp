#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Files that a command writes for people to change.

namespace mpm {

/// Refuses a path at which something is. Throws InputError.
void require_new(const std::filesystem::path& path);

/// Writes a new file, all or nothing. Throws InputError where there is one, std::runtime_error when it cannot
/// be written.
void write_new(const std::filesystem::path& path, std::string_view text);

/// The name of the file without its ending, with '-' for what is no letter, digit, '_' or '-': a name that a
/// study or a method may have, at most 64 bytes.
std::string name_of_file(const std::filesystem::path& path);

}  // namespace mpm
