#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// Turns what an outside program wrote into one line of printable ASCII for messages and archives. A longer
/// text is cut to `most` bytes and "...".
std::string foreign_text(std::string_view text, std::size_t most);

}  // namespace mpm
