#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// Compresses `content` with zlib. Constant signals take hardly any bytes.
std::string deflated(std::string_view content);

/// Restores the content. Throws std::runtime_error if the bytes do not come from deflated().
std::string inflated(std::string_view bytes);

}  // namespace mpm
