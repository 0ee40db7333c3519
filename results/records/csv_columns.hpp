#pragma once

#include <string>
#include <string_view>

#include "results/records/record_columns.hpp"

namespace mpm {

/// Reads a CSV text: fields in double quotes where they hold the separator (RFC 4180), line ends of any
/// system, a byte order mark, empty lines, and lines that begin with '#' before the heading. `separator` is
/// one character; empty: the one of , ; tab | that the heading has most often. The decimal sign is ".".
///
/// Errors: InputError that names the file, the line, and what to do, for a text that is no such file: bytes
/// that are no text, no heading, no rows, a row with another number of fields (decimal commas).
RecordColumns parse_csv(std::string_view text, const std::string& file, const std::string& separator);

}  // namespace mpm
