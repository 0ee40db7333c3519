#include "results/records/record_columns.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "scenarios/toml/nearest_name.hpp"

namespace mpm {
namespace {

constexpr std::size_t kColumnsShown = 20;

bool differ_in_capitals_only(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string columns_text(const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(names.size(), kColumnsShown); ++i)
    shown.emplace_back(cut_utf8(names[i], kShownBytes));
  if (shown.size() < names.size())
    shown.push_back(fmt::format("{} more", names.size() - shown.size()));
  return fmt::format("one of the columns {}", fmt::join(shown, ", "));
}

}  // namespace

std::optional<double> RecordColumns::number(std::string cell) const {
  if (decimal == ',')
    std::replace(cell.begin(), cell.end(), ',', '.');
  const std::size_t sign = cell.starts_with('+') ? 1 : 0;
  double value = 0.0;
  const char* const end = cell.data() + cell.size();
  const auto [last, error] = std::from_chars(cell.data() + sign, end, value);
  return error == std::errc() && last == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::size_t> RecordColumns::find(const std::string& name) const {
  std::optional<std::size_t> found;
  for (std::size_t place = 0; place < names.size(); ++place)
    if (names[place] == name) {
      if (found)
        throw InputError(fmt::format("{}: column '{}'", file, name), "two columns of this name",
                         "one: rename the other");
      found = place;
    }
  for (std::size_t place = 0; place < names.size() && !found; ++place)
    if (differ_in_capitals_only(names[place], name))
      found = place;
  return found;
}

std::size_t RecordColumns::column(const std::string& place, const std::string& name) const {
  if (const auto found = find(name))
    return *found;
  const std::string nearest = nearest_name(name, names);
  throw InputError(
      place,
      fmt::format("no column '{}'{}", name, nearest.empty() ? "" : fmt::format(" (nearest: '{}')", nearest)),
      columns_text(names));
}

void RecordColumns::keep_rows(const std::vector<std::size_t>& kept) {
  const auto pick = [&](auto& values) {
    std::remove_cvref_t<decltype(values)> picked;
    for (const std::size_t row : kept)
      picked.push_back(std::move(values[row]));
    values = std::move(picked);
  };
  for (auto& cells : columns)
    pick(cells);
  pick(lines);
}

char found_decimal(const RecordColumns& columns) {
  std::size_t commas = 0, points = 0;
  for (const auto& column : columns.columns)
    for (const std::string& cell : column) {
      const bool digits = cell.find_first_not_of("+-0123456789.,eE") == std::string::npos;
      commas += digits && std::count(cell.begin(), cell.end(), ',') == 1 ? 1 : 0;
      points += digits && std::count(cell.begin(), cell.end(), '.') == 1 ? 1 : 0;
    }
  return commas > points ? ',' : '.';
}

}  // namespace mpm
