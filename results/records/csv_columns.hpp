#pragma once

#include <string>
#include <string_view>

#include "results/files/csv_text.hpp"
#include "results/records/record_columns.hpp"

namespace mpm {

/// Reads the columns of a CSV text with CsvReader. Rows right below the heading that hold neither a number
/// nor a date are taken as units, with a warning. The decimal sign is ".".
///
/// Errors: those of CsvReader; InputError if there is only one column, no heading or no row.
RecordColumns parse_csv(std::string_view text, const std::string& file, CsvForm form = {});

}  // namespace mpm
