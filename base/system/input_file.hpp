#pragma once

#include <filesystem>
#include <fstream>
#include <istream>
#include <string>

namespace mpm {

/// Opens a file of the user for reading. It must be a regular file, or a link to one: a pipe or a device may
/// never deliver data, or never end. Throws InputError with `path`, what is in the way, and `allowed`.
std::ifstream open_input(const std::filesystem::path& path, const std::string& allowed);

/// The rest of a stream. Much faster than iterators over its characters.
std::string content_of(std::istream& stream);

}  // namespace mpm
