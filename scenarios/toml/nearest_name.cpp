#include "scenarios/toml/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace mpm {
namespace {

/// Longer names are no misspellings, and comparing them costs time in proportion to their length.
constexpr std::size_t kLongestMisspelt = 64;

/// Computes the table of distances between the beginnings of `a` and `b`, row by row.
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

std::vector<std::string> nearest_names(std::string_view name, const std::vector<std::string>& names,
                                       std::size_t most) {
  if (name.size() > kLongestMisspelt)
    return {};
  std::vector<std::pair<std::size_t, std::size_t>> near;  // distance, place
  for (std::size_t place = 0; place < names.size(); ++place)
    if (const std::size_t distance = edit_distance(name, names[place]); distance <= name.size() / 2)
      near.emplace_back(distance, place);
  std::sort(near.begin(), near.end());
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < std::min(most, near.size()); ++i)
    nearest.push_back(names[near[i].second]);
  return nearest;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  const std::vector<std::string> nearest = nearest_names(name, names, 1);
  return nearest.empty() ? std::string() : nearest.front();
}

}  // namespace mpm
