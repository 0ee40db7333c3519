#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// One line of printable ASCII out of whatever somebody else's program wrote, at most `most` bytes and "..."
/// of it: it goes into messages and archives.
std::string foreign_text(std::string_view text, std::size_t most);

}  // namespace mpm
