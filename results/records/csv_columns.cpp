#include "results/records/csv_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/records/date_words.hpp"
#include "results/records/written_date.hpp"

namespace mpm {
namespace {

bool begins_with_number(const std::string& field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end != field.data();
}

/// Tells whether a field may be a number: it has digits and only signs of numbers, unlike a unit such as
/// 1/min.
bool may_be_number(const std::string& field) {
  return field.find_first_of("0123456789") != std::string::npos &&
         field.find_first_not_of("+-0123456789.,eE' ") == std::string::npos;
}

/// Removes the rows of units. A file that has no other rows keeps them.
void take_units(RecordColumns& csv) {
  constexpr std::size_t kMostRows = 5;
  const auto says_nothing = [&csv](std::size_t row) {
    return std::none_of(csv.columns.begin(), csv.columns.end(), [&](const auto& column) {
      return may_be_number(column[row]) || is_date(column[row]);
    });
  };
  std::size_t rows = 0;
  while (rows < std::min(kMostRows, csv.rows()) && says_nothing(rows))
    ++rows;
  if (rows == 0 || rows == csv.rows() || says_nothing(rows))
    return;
  for (const auto& column : csv.columns)
    csv.units.push_back(column.front());
  csv.warnings.push_back(rows == 1
                             ? fmt::format("line {} has neither a number nor a date: units", csv.lines[0])
                             : fmt::format("lines {} to {} have neither a number nor a date: units",
                                           csv.lines[0], csv.lines[rows - 1]));
  std::vector<std::size_t> kept(csv.rows() - rows);
  std::iota(kept.begin(), kept.end(), rows);
  csv.keep_rows(kept);
}

}  // namespace

RecordColumns parse_csv(std::string_view text, const std::string& file, CsvForm form) {
  CsvReader reader(text, file, std::move(form));
  RecordColumns csv;
  csv.file = file;
  csv.separator = reader.separator();
  csv.names = reader.heading();
  if (csv.names.size() == 1)
    throw InputError(reader.place(), "one column",
                     "a heading with the names of the columns, separated by , ; tab or | (data.separator); "
                     "data.skip for lines of a title before it");
  if (!csv.names.empty() && std::all_of(csv.names.begin(), csv.names.end(), begins_with_number))
    throw InputError(reader.place(), "numbers",
                     "a heading with the names of the columns; data.skip for lines before it");
  csv.columns.resize(csv.names.size());
  for (std::vector<std::string> fields; reader.next(fields);) {
    for (std::size_t column = 0; column < fields.size(); ++column)
      csv.columns[column].push_back(std::move(fields[column]));
    csv.lines.push_back(reader.line());
  }
  if (csv.rows() == 0)
    throw InputError(file, csv.names.empty() ? "nothing" : "a heading and no rows",
                     "a heading with the names of the columns, and a row a time stamp");
  take_units(csv);
  return csv;
}

}  // namespace mpm
