#include "scenarios/toml/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace mpm {
namespace {

/// Longer names are no misspellings, and comparing them costs time in proportion to their length.
constexpr std::size_t kLongestMisspelt = 64;

/// Row by row of the table of distances between the beginnings of `a` and `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  if (name.size() > kLongestMisspelt) {
    return {};
  }
  std::string nearest;
  std::size_t smallest = name.size() / 2 + 1;
  for (const std::string& candidate : names) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace mpm
