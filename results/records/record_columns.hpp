#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mpm {

/// A file of records as it is: names and cells, all of them texts without blanks around them.
struct RecordColumns {
  std::string file;  ///< for messages
  char separator = ',';
  char decimal = '.';
  char group = '\0';               ///< sign between thousands, besides blanks and '; '\0': none
  std::vector<std::string> names;  ///< of the columns
  std::vector<std::vector<std::string>> columns;  ///< [column][row]
  std::vector<std::size_t> lines;                 ///< number of each row's line in the file
  std::vector<std::string> units;                 ///< of each column, if a row below the heading has them
  std::vector<std::string> warnings;              ///< assumptions about the file that need a look
  std::map<std::string, std::string> left_out;    ///< content of the file that is no column, and the reason

  std::size_t rows() const { return lines.size(); }
  /// Reads a cell as a number in the form of the file; none if it is no number.
  std::optional<double> number(std::string cell) const;
  /// Finds the column of this name, or else one whose name differs only in capitals. Errors: InputError if
  /// two columns have this name.
  std::optional<std::size_t> find(const std::string& name) const;
  /// Returns the column of this name, which must exist; `place` says what asks for it. Errors: InputError,
  /// which says why the column was left out, or names the nearest column and lists all columns.
  std::size_t column(const std::string& place, const std::string& name) const;
  /// Keeps these rows, in this order.
  void keep_rows(const std::vector<std::size_t>& kept);
};

/// Lists some of what was left out, as ", but 'x' (why), ..."; empty if nothing was.
std::string left_out_text(const RecordColumns& columns);

/// Finds the decimal sign and the sign between thousands from the cells. `decimal` is the decimal sign, if
/// known, else '\0'. The decimal sign is "," if more cells have a single comma than a single point, unless
/// signs between thousands prove otherwise (12,345.6 or 1,234,567). Only such a proof gives a sign between
/// thousands.
void find_number_form(RecordColumns& columns, char decimal);

}  // namespace mpm
