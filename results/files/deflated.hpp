#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// `content` compressed by zlib: constant signals take hardly any bytes.
std::string deflated(std::string_view content);

/// The content again. Throws std::runtime_error when these bytes do not come from deflated().
std::string inflated(std::string_view bytes);

}  // namespace mpm
