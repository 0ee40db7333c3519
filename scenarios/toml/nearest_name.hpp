#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The entries of `names` that a misspelt `name` may mean, nearest first: fewest insertions, deletions and
/// replacements of one character (Levenshtein distance), in the order of `names` if they are equally many. At
/// most `most` of them, and none for which more than half of `name` would have to change.
std::vector<std::string> nearest_names(std::string_view name, const std::vector<std::string>& names,
                                       std::size_t most);

/// The first of them, or an empty text.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

}  // namespace mpm
