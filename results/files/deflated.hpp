#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// `content` in fewer bytes, by zlib: signals that stay where they are take hardly any.
std::string deflated(std::string_view content);

/// The content again. Throws std::runtime_error when these bytes do not come from deflated().
std::string inflated(std::string_view bytes);

}  // namespace mpm
