#include "results/records/csv_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

constexpr std::string_view kSeparators = ",;\t|";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string at_line(const std::string& file, std::size_t line) {
  return fmt::format("{}:{}", file, line);
}

void refuse_bytes(std::string_view text, const std::string& file) {
  const bool utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  if (utf16 || text.find('\0') != std::string_view::npos)
    throw InputError(file, utf16 ? "a text in UTF-16" : "bytes that are no text",
                     "a CSV file in UTF-8 or ASCII: export it again, or save the sheet as \"CSV UTF-8\"");
}

/// The next line of `text` from `at` on; a field in quotes may hold line breaks.
std::string_view next_line(std::string_view text, std::size_t& at) {
  const std::size_t first = at;
  bool quoted = false;
  for (; at < text.size() && (quoted || text[at] != '\n'); ++at)
    quoted ^= text[at] == '"';
  const std::string_view line = text.substr(first, at - first);
  if (at < text.size())
    ++at;
  return line;
}

std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == separator && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[i];
  }
  for (std::string& field : fields)
    field = std::string(trimmed(field));
  return fields;
}

/// The one that the heading has most often.
char found_separator(std::string_view heading, const std::string& file) {
  const auto count = [&](char c) { return std::count(heading.begin(), heading.end(), c); };
  const char most = *std::max_element(kSeparators.begin(), kSeparators.end(),
                                      [&](char a, char b) { return count(a) < count(b); });
  if (count(most) == 0)
    throw InputError(at_line(file, 1), "one column",
                     "a heading with the names of the columns, separated by , ; tab or | (data.separator)");
  return most;
}

bool is_number(const std::string& field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end != field.data();
}

void refuse_ragged(const RecordColumns& csv, std::size_t line, std::size_t fields) {
  const bool decimal_commas = csv.separator == ',' && fields > csv.names.size();
  throw InputError(
      at_line(csv.file, line), fmt::format("{} fields", fields),
      fmt::format("{}, as the heading has them{}", csv.names.size(),
                  decimal_commas ? "; if these are decimal commas in a file separated by commas, export it "
                                   "with ';' between the columns, or with decimal points"
                                 : ""));
}

}  // namespace

RecordColumns parse_csv(std::string_view text, const std::string& file, const std::string& separator) {
  refuse_bytes(text, file);
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  RecordColumns csv;
  csv.file = file;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view raw = next_line(text, at);
    ++line;
    const std::size_t first_line = line;
    line += static_cast<std::size_t>(std::count(raw.begin(), raw.end(), '\n'));
    if (trimmed(raw).empty() || (csv.names.empty() && trimmed(raw).starts_with('#')))
      continue;
    if (csv.names.empty()) {
      csv.separator = separator.empty() ? found_separator(raw, file) : separator.front();
      csv.names = fields_of(raw, csv.separator);
      if (std::all_of(csv.names.begin(), csv.names.end(), is_number))
        throw InputError(at_line(file, first_line), "numbers", "a heading with the names of the columns");
      csv.columns.resize(csv.names.size());
      continue;
    }
    std::vector<std::string> fields = fields_of(raw, csv.separator);
    if (fields.size() != csv.names.size())
      refuse_ragged(csv, first_line, fields.size());
    for (std::size_t column = 0; column < fields.size(); ++column)
      csv.columns[column].push_back(std::move(fields[column]));
    csv.lines.push_back(first_line);
  }
  if (csv.rows() == 0)
    throw InputError(file, csv.names.empty() ? "nothing" : "a heading and no rows",
                     "a heading with the names of the columns, and a row a time stamp");
  return csv;
}

}  // namespace mpm
