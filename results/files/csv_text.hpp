#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

inline constexpr std::size_t kLongestCsvName = 1000;  ///< longest name of a column, in bytes
/// Limits for a file of another program: columns, and rows times columns.
inline constexpr std::size_t kMostForeignColumns = 50'000, kMostForeignCells = 50'000'000;

/// How the form of a CSV text may differ from the default.
struct CsvForm {
  std::string separator = {};        ///< one character; empty: the most frequent of , ; tab | in the heading
  bool comments_everywhere = false;  ///< '#' begins a comment on any line; if false, only before the heading
  std::size_t most_cells = kMostForeignCells;
  std::vector<int> skip = {};  ///< numbers of lines that are not read, counted from 1
};

/// Reads a CSV text of another program line by line. Records and verdicts are both read with it.
///
/// It accepts UTF-8 and UTF-16, a byte order mark, empty lines, the line ends of any system, and a first line
/// "sep=;", with which spreadsheets name their separator. Blanks around a field are dropped, and so are empty
/// fields after the last column of the heading. There is one rule for quotes: a field whose first character
/// is '"' ends at the next '"' that is not doubled, on the same line, and only blanks may follow it; any
/// other '"' is an ordinary character (5" pipe). So a quote that somebody forgot to close never reaches
/// beyond its line.
///
/// Errors: InputError "FILE:LINE: found ...; allowed: ..." for bytes that are no text, a quote that breaks
/// the rule, a row whose number of fields differs from the heading, a name of more than kLongestCsvName
/// bytes, more than kMostForeignColumns columns, and more than CsvForm::most_cells cells.
class CsvReader {
 public:
  /// Reads up to the heading; `text` must outlive the reader. heading() is empty if the text has none.
  CsvReader(std::string_view text, std::string file, CsvForm form = {});
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  char separator() const { return separator_; }
  const std::vector<std::string>& heading() const { return heading_; }
  /// The comment lines read so far, without the blanks around them.
  const std::vector<std::string>& comments() const { return comments_; }

  /// Reads the next row, which has as many fields as the heading; returns false at the end.
  bool next(std::vector<std::string>& fields);

  /// The number of the line that was read last, and that place as "FILE:LINE".
  std::size_t line() const { return line_; }
  std::string place() const;

 private:
  bool next_line(std::string_view& line);
  std::vector<std::string> fields_of(std::string_view line) const;
  void read_heading();

  std::string decoded_;  ///< `text` converted from UTF-16; otherwise empty
  std::string_view text_;
  std::string file_;
  CsvForm form_;
  char separator_ = ',';
  std::vector<std::string> heading_, comments_;
  std::size_t at_ = 0, line_ = 0, cells_ = 0;
};

/// Returns a text as a CSV field, in quotes if needed. A text that a spreadsheet would take for a formula (it
/// begins with = + - @, a tab or a return) gets a leading '.
std::string csv_field(const std::string& text);

}  // namespace mpm
