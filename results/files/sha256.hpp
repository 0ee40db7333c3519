#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mpm {

/// SHA-256 in hexadecimal digits, as sha256sum prints it.
std::string sha256(std::span<const std::byte> content);

}  // namespace mpm
