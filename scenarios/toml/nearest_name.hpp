#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The one of `names` that a misspelt `name` most likely means: fewest insertions, deletions and replacements
/// of one character (Levenshtein distance), the first of several. Empty when none is near, that is, when more
/// than half of `name` would have to change.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

}  // namespace mpm
