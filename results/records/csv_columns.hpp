#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// A CSV file as it stands: a heading and cells, all texts without blanks around them.
struct CsvColumns {
  std::string file;  ///< for messages
  char separator = ',';
  std::vector<std::string> names;                 ///< of the columns
  std::vector<std::vector<std::string>> columns;  ///< [column][row]
  std::vector<std::size_t> lines;                 ///< in the file, of each row

  std::size_t rows() const { return lines.size(); }
};

/// Reads a CSV text: fields in double quotes where they hold the separator (RFC 4180), line ends of any
/// system, a byte order mark, empty lines, and lines that begin with '#' before the heading. `separator` is
/// one character; empty: the one of , ; tab | that the heading has most often.
///
/// Errors: InputError that names the file, the line, and what to do, for a text that is no such file: bytes
/// that are no text, no heading, no rows, a row with another number of fields (decimal commas).
CsvColumns parse_csv(std::string_view text, const std::string& file, const std::string& separator);

}  // namespace mpm
