#include "results/files/csv_text.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

constexpr std::string_view kSeparators = ",;\t|";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

void refuse_bytes(std::string_view text, const std::string& file) {
  if (text.find('\0') != std::string_view::npos)
    throw InputError(
        file, "bytes that are not text",
        "a CSV file in UTF-8, UTF-16 or ASCII: export it again, or save the sheet as \"CSV UTF-8\"");
}

/// Returns the separator that a spreadsheet names in the first line, if it does.
std::optional<char> named_separator(std::string_view line) {
  line = without_blanks(line);
  if (line.size() == 7 && line.front() == '"' && line.back() == '"')
    line = line.substr(1, 5);
  const bool named = line.size() == 5 && (line.starts_with("sep=") || line.starts_with("SEP="));
  return named ? std::optional(line.back()) : std::nullopt;
}

/// Returns the separator that occurs most often in the heading.
char found_separator(std::string_view heading) {
  const auto count = [&](char c) { return std::count(heading.begin(), heading.end(), c); };
  return *std::max_element(kSeparators.begin(), kSeparators.end(),
                           [&](char a, char b) { return count(a) < count(b); });
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file, CsvForm form)
    : decoded_(is_utf16(text) ? utf8_of_utf16(text) : std::string()),
      text_(is_utf16(text) ? decoded_ : text),
      file_(std::move(file)),
      form_(std::move(form)) {
  refuse_bytes(text_, file_);
  if (text_.starts_with(kByteOrderMark))
    text_.remove_prefix(kByteOrderMark.size());
  read_heading();
}

std::string CsvReader::place() const {
  return fmt::format("{}:{}", file_, line_);
}

/// Finds the next line that is neither empty nor skipped nor a comment.
bool CsvReader::next_line(std::string_view& line) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    line = text_.substr(at_, end - at_);
    at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
    ++line_;
    const std::string_view content = without_blanks(line);
    const bool skipped = std::find(form_.skip.begin(), form_.skip.end(), line_) != form_.skip.end();
    if (content.empty() || skipped)
      continue;
    if (!content.starts_with('#') || !(heading_.empty() || form_.comments_everywhere))
      return true;
    comments_.emplace_back(content);
  }
  return false;
}

std::vector<std::string> CsvReader::fields_of(std::string_view line) const {
  std::vector<std::string> fields;
  for (std::size_t at = 0; at <= line.size();) {
    std::string field;
    std::size_t first = at;  // start of the field after the blanks before it
    while (first < line.size() && (line[first] == ' ' || line[first] == '\t') && line[first] != separator_)
      ++first;
    if (first < line.size() && line[first] == '"' && line[first] != separator_) {
      std::size_t close = first + 1;
      for (;; ++close) {
        const std::size_t next = line.find('"', close);
        if (next == std::string_view::npos)
          throw InputError(
              place(), "a quote that is not closed on its line",
              "a field that begins with \" ends with \" on its line, and holds \"\" for each \"");
        field += line.substr(close, next - close);
        close = next + 1;
        if (!line.substr(close).starts_with('"'))
          break;
        field += '"';
      }
      at = std::min(line.find(separator_, close), line.size());
      if (const std::string_view behind = without_blanks(line.substr(close, at - close)); !behind.empty())
        throw InputError(place(), fmt::format("'{}' after a quoted field", cut_utf8(behind, kShownBytes)),
                         "the separator or the end of the line, and \"\" for each \" in a field in quotes");
      field = without_blanks(field);
    } else {
      const std::size_t end = std::min(line.find(separator_, at), line.size());
      field = without_blanks(line.substr(at, end - at));
      at = end;
    }
    fields.push_back(std::move(field));
    ++at;
  }
  return fields;
}

void CsvReader::read_heading() {
  std::string_view line;
  if (!next_line(line))
    return;
  const std::optional<char> named = named_separator(line);
  if (named && !next_line(line))
    return;
  separator_ = !form_.separator.empty() ? form_.separator.front() : named.value_or(found_separator(line));
  if (const auto columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), separator_)) + 1;
      columns > kMostForeignColumns)
    throw InputError(place(), fmt::format("a heading of {} columns", columns),
                     fmt::format("at most {}: leave out the others", kMostForeignColumns));
  heading_ = fields_of(line);
  for (const std::string& name : heading_)
    if (name.size() > kLongestCsvName)
      throw InputError(
          place(),
          fmt::format("a column with a name of {} bytes, '{}...'", name.size(), cut_utf8(name, kShownBytes)),
          fmt::format("at most {}", kLongestCsvName));
}

bool CsvReader::next(std::vector<std::string>& fields) {
  std::string_view line;
  if (!next_line(line))
    return false;
  fields = fields_of(line);
  while (fields.size() > heading_.size() && fields.back().empty())
    fields.pop_back();
  if (fields.size() != heading_.size()) {
    const bool decimal_commas = separator_ == ',' && fields.size() > heading_.size();
    throw InputError(
        place(), fmt::format("{} fields", fields.size()),
        fmt::format("{}, as the heading has them{}", heading_.size(),
                    heading_.size() == 1 ? "; if lines of a title stand before it: data.skip"
                    : decimal_commas
                        ? "; if these are decimal commas in a file separated by commas, export it "
                          "with ';' between the columns, or with decimal points"
                        : ""));
  }
  cells_ += fields.size();
  if (cells_ > form_.most_cells)
    throw InputError(place(), fmt::format("more than {} cells", form_.most_cells),
                     "at most this many (rows times columns): use a shorter period, fewer columns, or fewer "
                     "rows per sample");
  return true;
}

std::string csv_field(const std::string& text) {
  const bool formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  std::string shown = formula ? "'" + text : text;
  if (shown.find_first_of(",\"\r\n") == std::string::npos)
    return shown;
  std::string quoted = "\"";
  for (const char c : shown)
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace mpm
