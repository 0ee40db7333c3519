#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// One line of printable ASCII from what an outside program wrote, cut to `most` bytes and "...", for
/// messages and archives.
std::string foreign_text(std::string_view text, std::size_t most);

}  // namespace mpm
