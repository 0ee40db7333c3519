#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace mpm {

inline constexpr std::size_t kShownBytes = 60;  ///< of a text of somebody else in a message

/// The content of a file that somebody else has written, which goes to memory as a whole: at most 2 GB.
/// Throws InputError with the path, what is in the way (see open_input()) or its size, and `allowed`.
std::string foreign_content(const std::filesystem::path& path, const std::string& allowed);

}  // namespace mpm
