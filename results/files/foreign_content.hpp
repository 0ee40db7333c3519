#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace mpm {

inline constexpr std::size_t kShownBytes = 60;  ///< longest part of a foreign text in a message

/// Returns the content of a file of another program. It is read into memory as a whole, so at most 2 GB.
/// Throws InputError with the path, the obstacle (see open_input()) or the size, and `allowed`.
std::string foreign_content(const std::filesystem::path& path, const std::string& allowed);

}  // namespace mpm
