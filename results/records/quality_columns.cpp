#include "results/records/quality_columns.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "results/files/utf8.hpp"
#include "results/records/opc_quality.hpp"

namespace mpm {
namespace {

constexpr std::array<std::string_view, 12> kQualityWords{
    "quality", "status", "qual", "q", "qc", "valid", "validity", "good", "ok", "sts", "health", "flag"};
constexpr std::array<std::string_view, 5> kValueWords{"pv", "value", "val", "sp", "op"};
constexpr std::string_view kBetween = "._ -/:";
constexpr std::array<std::string_view, 3> kTagEndings{"pv", "sp", "op"};

template <std::size_t size>
bool is_word_of(std::string_view word, const std::array<std::string_view, size>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Removes the last part of a name if it stands for a value: "xd" for "xd.pv".
std::string_view without_value_word(std::string_view name) {
  const std::size_t at = name.find_last_of(kBetween);
  return at != std::string_view::npos && is_word_of(name.substr(at + 1), kValueWords) ? name.substr(0, at)
                                                                                      : name;
}

/// Tells whether `name` means the quality of `value`. Both are in small letters.
bool is_quality_of(std::string_view name, std::string_view value) {
  const std::size_t last = name.find_last_of(kBetween), first = name.find_first_of(kBetween);
  return last != std::string_view::npos &&
         ((is_word_of(name.substr(last + 1), kQualityWords) && name.substr(0, last) == value) ||
          (is_word_of(name.substr(0, first), kQualityWords) && name.substr(first + 1) == value));
}

}  // namespace

std::optional<std::size_t> quality_column_of(const RecordColumns& file, std::size_t column) {
  const std::string value = in_lower_case(file.names[column]);
  const std::string_view tag = without_value_word(value);
  std::vector<std::size_t> own, common;
  for (std::size_t other = 0; other < file.names.size(); ++other) {
    const std::string name = in_lower_case(file.names[other]);
    if (other == column)
      continue;
    if (is_quality_of(name, value) || is_quality_of(name, tag))
      own.push_back(other);
    else if ((name == "quality" || name == "status") && are_qualities(file, other))
      common.push_back(other);
  }
  const std::vector<std::size_t>& found = own.empty() ? common : own;
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

bool are_qualities(const RecordColumns& file, std::size_t column) {
  const OpcCodes codes = opc_codes(file, column);
  bool any_good = false, any_code = false, any_word = false;
  for (const std::string& cell : file.columns[column]) {
    if (cell.empty())
      continue;
    if (!is_opc_quality(file, cell, codes))
      return false;
    (is_opc_code(file, cell) ? any_code : any_word) = true;
    any_good = any_good || is_good_opc(file, cell, codes);
  }
  return any_good && any_code != any_word;  // either words or codes
}

std::optional<std::size_t> column_beside(const RecordColumns& file, std::size_t column,
                                         const std::string& ending) {
  const std::string& name = file.names[column];
  const std::string own = in_lower_case(name);
  const bool is_part_of_tag =
      own.size() > kTagEndings[0].size() &&
      std::any_of(kTagEndings.begin(), kTagEndings.end(),
                  [&own](std::string_view of_value) { return own.ends_with(of_value); });
  const std::string tag = is_part_of_tag ? name.substr(0, name.size() - kTagEndings[0].size()) : name + ".";
  const auto found = file.find(tag + ending);
  return found == column ? std::nullopt : found;
}

void name_repeated_qualities(RecordColumns& file) {
  for (const std::string_view word : kQualityWords) {
    std::vector<std::size_t> places;
    for (std::size_t column = 0; column < file.names.size(); ++column)
      if (in_lower_case(file.names[column]) == word)
        places.push_back(column);
    const bool repeated =
        places.size() > 1 && std::all_of(places.begin(), places.end(), [&](std::size_t column) {
          return file.names[column] == file.names[places.front()];
        });
    for (const std::size_t column : places)
      if (repeated && column > 0)
        file.names[column] = fmt::format("{}.{}", file.names[column - 1], file.names[column]);
  }
}

}  // namespace mpm
