#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// `text` as HDF5, netCDF and JSON take it: UTF-8 without NUL. Each byte that does not belong to a UTF-8
/// sequence, and each NUL, is replaced by U+FFFD; a proper text comes back as it is.
std::string proper_utf8(std::string_view text);

}  // namespace mpm
