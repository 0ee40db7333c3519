#pragma once

#include <string>
#include <string_view>

#include "results/files/csv_text.hpp"
#include "results/records/record_columns.hpp"

namespace mpm {

/// The columns of a CSV text, which CsvReader reads. Rows without a number and a date right below the heading
/// are taken as units, with a warning. The decimal sign is ".".
///
/// Errors: those of CsvReader; InputError for one column, no heading or no rows.
RecordColumns parse_csv(std::string_view text, const std::string& file, CsvForm form = {});

}  // namespace mpm
