#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Files that a command writes for people to change.

namespace mpm {

/// Throws InputError if there is something at this path.
void require_new(const std::filesystem::path& path);

/// Writes a new file, all or nothing. Throws InputError if there is one already, std::runtime_error if it
/// cannot be written.
void write_new(const std::filesystem::path& path, std::string_view text);

/// The name of the file without its ending, with '-' for every character that is no letter, digit, '_' or
/// '-': a name that a study or a method may have, at most 64 bytes.
std::string name_of_file(const std::filesystem::path& path);

}  // namespace mpm
