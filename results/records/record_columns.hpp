#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mpm {

/// A file of records as it stands: names and cells, all texts without blanks around them.
struct RecordColumns {
  std::string file;  ///< for messages
  char separator = ',';
  char decimal = '.';
  std::vector<std::string> names;                 ///< of the columns
  std::vector<std::vector<std::string>> columns;  ///< [column][row]
  std::vector<std::size_t> lines;                 ///< in the file, of each row

  std::size_t rows() const { return lines.size(); }
  /// The cell as a number with the decimal sign of the file; none when it is not one.
  std::optional<double> number(std::string cell) const;
  /// The column of this name; of one that differs in capitals only where there is no other. Errors:
  /// InputError for two columns of this name.
  std::optional<std::size_t> find(const std::string& name) const;
  /// The column of this name, which must be there: `place` is what asks for it. Errors: InputError with the
  /// nearest column and all there are.
  std::size_t column(const std::string& place, const std::string& name) const;
  /// Keeps these rows, in this order.
  void keep_rows(const std::vector<std::size_t>& kept);
};

/// "," where numbers are written so: more cells have one comma than one point. The file may have any of them.
char found_decimal(const RecordColumns& columns);

}  // namespace mpm
