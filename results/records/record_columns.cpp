#include "results/records/record_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "scenarios/toml/nearest_name.hpp"

namespace mpm {
namespace {

constexpr std::size_t kColumnsShown = 20;

std::string columns_text(const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(names.size(), kColumnsShown); ++i)
    shown.emplace_back(cut_utf8(names[i], kShownBytes));
  if (shown.size() < names.size())
    shown.push_back(fmt::format("{} more", names.size() - shown.size()));
  return fmt::format("one of the columns {}", fmt::join(shown, ", "));
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Tells whether a number has one to three digits, then groups of three with this sign before each, then
/// perhaps a fraction.
bool is_grouped(std::string_view cell, char group, char decimal) {
  constexpr std::size_t kDigits = 3;
  if (cell.starts_with('+') || cell.starts_with('-'))
    cell.remove_prefix(1);
  const std::string_view whole = cell.substr(0, cell.find(decimal));
  const std::string_view fraction = cell.substr(std::min(whole.size() + 1, cell.size()));
  const std::size_t first = whole.find(group);
  if (first == 0 || first > kDigits || !std::all_of(fraction.begin(), fraction.end(), is_digit))
    return false;  // also if there is no sign: npos
  if ((whole.size() - first) % (kDigits + 1) != 0)
    return false;
  for (std::size_t at = 0; at < whole.size(); ++at)
    if ((at >= first && (at - first) % (kDigits + 1) == 0) ? whole[at] != group : !is_digit(whole[at]))
      return false;
  return true;
}

/// Removes the signs between thousands: `group`, if the file has one, a blank of any kind, or '.
void drop_groups(std::string& cell, char decimal, char group) {
  if (cell.find_first_not_of("+-0123456789.,eE") == std::string::npos) {
    if (group != '\0' && cell.find(group) != std::string::npos && is_grouped(cell, group, decimal))
      std::erase(cell, group);
    return;
  }
  if (cell.empty() || cell.find_first_of(" '\xC2\xE2") == std::string::npos)
    return;
  std::string plain = cell;
  for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x99", "'"})
    for (std::size_t at = plain.find(blank); at != std::string::npos; at = plain.find(blank, at))
      plain.replace(at, blank.size(), " ");
  if (is_grouped(plain, ' ', decimal)) {
    std::erase(plain, ' ');
    cell = std::move(plain);
  }
}

}  // namespace

std::optional<double> RecordColumns::number(std::string cell) const {
  drop_groups(cell, decimal, group);
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
    if (names[place].size() == name.size() && in_lower_case(names[place]) == in_lower_case(name))
      found = place;
  return found;
}

std::size_t RecordColumns::column(const std::string& place, const std::string& name) const {
  if (const auto found = find(name))
    return *found;
  if (const auto out = left_out.find(name); out != left_out.end())
    throw InputError(place, fmt::format("'{}', which is no column: {}", name, out->second),
                     columns_text(names));
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

std::string left_out_text(const RecordColumns& columns) {
  constexpr std::size_t kMostShown = 3;
  std::vector<std::string> shown;
  for (const auto& [name, why] : columns.left_out)
    if (shown.size() < kMostShown)
      shown.push_back(fmt::format("'{}' ({})", cut_utf8(name, kShownBytes), why));
  return shown.empty() ? "" : fmt::format(", but {}", fmt::join(shown, ", "));
}

void find_number_form(RecordColumns& columns, char decimal) {
  std::size_t commas = 0, points = 0, groups_of_commas = 0, groups_of_points = 0;
  for (const auto& column : columns.columns)
    for (const std::string& cell : column) {
      if (cell.find_first_of(".,") == std::string::npos ||
          cell.find_first_not_of("+-0123456789.,eE") != std::string::npos)
        continue;
      const auto of_comma = std::count(cell.begin(), cell.end(), ',');
      const auto of_point = std::count(cell.begin(), cell.end(), '.');
      commas += of_comma == 1 && of_point == 0 ? 1 : 0;
      points += of_point == 1 && of_comma == 0 ? 1 : 0;
      groups_of_commas += of_comma + of_point > 1 && is_grouped(cell, ',', '.') ? 1 : 0;
      groups_of_points += of_comma + of_point > 1 && is_grouped(cell, '.', ',') ? 1 : 0;
    }
  const bool proven = groups_of_commas != groups_of_points;
  if (decimal == '\0')
    decimal = (proven ? groups_of_points > groups_of_commas : commas > points) ? ',' : '.';
  columns.decimal = decimal;
  const bool grouped = (decimal == '.' ? groups_of_commas : groups_of_points) > 0;
  columns.group = !grouped ? '\0' : decimal == '.' ? ',' : '.';
}

}  // namespace mpm
