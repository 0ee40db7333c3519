#include "results/records/csv_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/files/csv_text.hpp"

namespace mpm {
namespace {

bool begins_with_number(const std::string& field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end != field.data();
}

}  // namespace

RecordColumns parse_csv(std::string_view text, const std::string& file, const std::string& separator) {
  CsvReader reader(text, file, {.separator = separator});
  RecordColumns csv;
  csv.file = file;
  csv.separator = reader.separator();
  csv.names = reader.heading();
  if (csv.names.size() == 1)
    throw InputError(reader.place(), "one column",
                     "a heading with the names of the columns, separated by , ; tab or | (data.separator)");
  if (!csv.names.empty() && std::all_of(csv.names.begin(), csv.names.end(), begins_with_number))
    throw InputError(reader.place(), "numbers", "a heading with the names of the columns");
  csv.columns.resize(csv.names.size());
  for (std::vector<std::string> fields; reader.next(fields);) {
    for (std::size_t column = 0; column < fields.size(); ++column)
      csv.columns[column].push_back(std::move(fields[column]));
    csv.lines.push_back(reader.line());
  }
  if (csv.rows() == 0)
    throw InputError(file, csv.names.empty() ? "nothing" : "a heading and no rows",
                     "a heading with the names of the columns, and a row a time stamp");
  return csv;
}

}  // namespace mpm
