#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mpm {

/// A file of records as it stands: names and cells, all texts without blanks around them.
struct RecordColumns {
  std::string file;  ///< for messages
  char separator = ',';
  char decimal = '.';
  char group = '\0';                              ///< between thousands, beside blanks and '; '\0': none
  std::vector<std::string> names;                 ///< of the columns
  std::vector<std::vector<std::string>> columns;  ///< [column][row]
  std::vector<std::size_t> lines;                 ///< in the file, of each row
  std::vector<std::string> units;                 ///< of the columns, where a row below the heading has them
  std::vector<std::string> warnings;              ///< assumptions about the file that need a look
  std::map<std::string, std::string> left_out;    ///< content of the file that is no column, and why

  std::size_t rows() const { return lines.size(); }
  /// The cell as a number as the file writes them; none when it is not one.
  std::optional<double> number(std::string cell) const;
  /// The column of this name; of one that differs in capitals only where there is no other. Errors:
  /// InputError for two columns of this name.
  std::optional<std::size_t> find(const std::string& name) const;
  /// The column of this name, which must be there: `place` is what asks for it. Errors: InputError with why
  /// it was left out, or with the nearest column and all there are.
  std::size_t column(const std::string& place, const std::string& name) const;
  /// Keeps these rows, in this order.
  void keep_rows(const std::vector<std::size_t>& kept);
};

/// Some of what was left out, as ", but 'x' (why), ..."; empty: nothing was.
std::string left_out_text(const RecordColumns& columns);

/// The decimal sign and the sign between thousands that the cells show; `decimal` where it is known, else
/// '\0'. It is "," if more cells have one comma than one point, unless thousands prove it (12,345.6 or
/// 1,234,567): only then there is a sign between thousands.
void find_number_form(RecordColumns& columns, char decimal);

}  // namespace mpm
