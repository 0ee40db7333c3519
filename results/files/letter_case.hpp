#pragma once

#include <string>

namespace mpm {

/// The text with its capital letters as small ones. Bytes above ASCII, as of UTF-8, stay as they are.
std::string lower_case(std::string text);

}  // namespace mpm
