#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

inline constexpr std::size_t kLongestCsvName = 1000;  ///< bytes of the name of a column
/// Limits for a file of somebody else: columns, and rows times columns.
inline constexpr std::size_t kMostForeignColumns = 50'000, kMostForeignCells = 50'000'000;

/// How a CSV text may differ from the usual one.
struct CsvForm {
  std::string separator = {};  ///< one character; empty: the one of , ; tab | that the heading has most
  bool comments_everywhere =
      false;  ///< otherwise lines that begin with '#' are comments before the heading only
  std::size_t most_cells = kMostForeignCells;
  std::vector<int> skip = {};  ///< numbers of lines that are not read, from 1
};

/// A CSV text of somebody else, line by line: the one reader of records and of verdicts.
///
/// UTF-8 and UTF-16, a byte order mark, empty lines and the line ends of any system are read, and a first
/// line "sep=;", by which spreadsheets say what is between the fields. Fields stand without the blanks around
/// them; empty ones behind the last one of the heading are dropped. One rule for quotes: a field whose first
/// character is '"' ends at the next '"' that is not doubled, on the same line, and only blanks may follow
/// it; any other '"' is a character like all others (5" pipe). So no quote reaches beyond its line, whoever
/// forgot to close it.
///
/// Errors: InputError "FILE:LINE: found ...; allowed: ..." for bytes that are no text, a quote that breaks
/// the rule, a row with another number of fields than the heading, a name of more than kLongestCsvName
/// bytes, more than kMostForeignColumns columns, and more than CsvForm::most_cells cells.
class CsvReader {
 public:
  /// Reads up to the heading; `text` must outlive the reader. Without a heading heading() is empty.
  CsvReader(std::string_view text, std::string file, CsvForm form = {});
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  char separator() const { return separator_; }
  const std::vector<std::string>& heading() const { return heading_; }
  /// The lines that were comments so far, without the blanks around them.
  const std::vector<std::string>& comments() const { return comments_; }

  /// The next row, as many fields as the heading has; false at the end.
  bool next(std::vector<std::string>& fields);

  /// The number of the line that was read last, and "FILE:LINE".
  std::size_t line() const { return line_; }
  std::string place() const;

 private:
  bool next_line(std::string_view& line);
  std::vector<std::string> fields_of(std::string_view line) const;
  void read_heading();

  std::string decoded_;  ///< of UTF-16
  std::string_view text_;
  std::string file_;
  CsvForm form_;
  char separator_ = ',';
  std::vector<std::string> heading_, comments_;
  std::size_t at_ = 0, line_ = 0, cells_ = 0;
};

/// A text as a field of CSV, in quotes where it must be. One that a spreadsheet would take for a formula (it
/// begins with = + - @, a tab or a return) has ' in front.
std::string csv_field(const std::string& text);

}  // namespace mpm
