#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mpm {

/// Bytes as text (RFC 4648, section 4), without line ends.
std::string base64(std::span<const std::byte> bytes);

}  // namespace mpm
