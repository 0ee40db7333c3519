#pragma once

#include <string>
#include <string_view>

#include "results/records/record_columns.hpp"

namespace mpm {

/// The columns of a CSV text, which CsvReader reads. `separator` is one character; empty: found. The decimal
/// sign is ".".
///
/// Errors: those of CsvReader; InputError for one column, no heading or no rows.
RecordColumns parse_csv(std::string_view text, const std::string& file, const std::string& separator);

}  // namespace mpm
