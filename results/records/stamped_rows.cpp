#include "results/records/stamped_rows.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/date_words.hpp"
#include "results/records/quality_columns.hpp"
#include "results/records/time_order.hpp"
#include "results/records/written_date.hpp"

namespace mpm {
namespace {

constexpr std::array kTimeHeadings{"time", "timestamp", "datetime", "date", "t"};
constexpr std::array kTagHeadings{"tag",       "tagname", "tag name", "tag_name", "point",
                                  "pointname", "item",    "itemid",   "variable", "signal",
                                  "sensor",    "name",    "tag id",   "tag_id"};
constexpr std::array kValueHeadings{"value", "val", "wert", "reading"};

std::string shown_heading(const std::string& name) {
  return std::string(cut_utf8(name, kShownBytes));
}

/// Returns a heading in small letters, without the number by which a program tells several equal headings
/// apart (time.1, time_2).
std::string heading_base(std::string name) {
  const std::size_t letter = name.find_last_not_of("0123456789");
  if (letter != std::string::npos && letter > 0 && letter + 1 < name.size() &&
      (name[letter] == '.' || name[letter] == '_'))
    name.resize(letter);
  return in_lower_case(std::move(name));
}

const std::string* first_cell(const std::vector<std::string>& cells) {
  const auto found =
      std::find_if(cells.begin(), cells.end(), [](const std::string& cell) { return !cell.empty(); });
  return found == cells.end() ? nullptr : &*found;
}

/// Applies `reads` to the first cell. A number is never read: no language shall see the E of its exponent.
bool first_cell_is(bool (*reads)(std::string_view), const RecordColumns& file, std::size_t column) {
  const std::string* const cell = first_cell(file.columns[column]);
  return cell != nullptr && !file.number(*cell) && reads(*cell);
}

/// Values that share their time stamps: columns of the new file, and where their cells are in the original.
struct StampedSeries {
  struct Part {
    std::size_t column;  ///< column of the new file
    std::size_t source;  ///< column of the original file
  };
  std::vector<Part> parts;
  std::vector<std::size_t> rows;  ///< rows of the original file, ascending in time
};

class RowsReader {
 public:
  RowsReader(const RowsWanted& wanted, RecordColumns file)
      : data_(wanted.data), wanted_(wanted), file_(std::move(file)) {
    rows_.rules = stamp_rules(data_, file_.decimal, wanted.sample_time, wanted.time_unit);
  }

  StampedRows rows() {
    switch (layout()) {
      case TableLayout::long_table:
        read_long();
        break;
      case TableLayout::time_per_tag:
        read_time_per_tag();
        break;
      default:
        read_wide();
    }
    return std::move(rows_);
  }

 private:
  // --- Layout ---

  TableLayout layout() const {
    if (data_.layout != TableLayout::automatic)
      return data_.layout;
    if (!data_.tag_column.empty() || !data_.value_column.empty())
      return TableLayout::long_table;
    if (usual(kTagHeadings) && usual(kValueHeadings) && !has_wanted())
      return TableLayout::long_table;
    return stamp_columns().size() > 1 ? TableLayout::time_per_tag : TableLayout::wide;
  }

  template <std::size_t size>
  std::optional<std::size_t> usual(const std::array<const char*, size>& headings) const {
    for (const char* heading : headings)
      if (const auto column = file_.find(heading))
        return column;
    return std::nullopt;
  }

  bool has_wanted() const {
    return std::any_of(wanted_.names.begin(), wanted_.names.end(),
                       [&](const std::string& name) { return file_.find(name).has_value(); });
  }

  /// Returns the columns of stamps that share a heading. If the study names the layout, columns of dates
  /// count as well.
  std::vector<std::size_t> stamp_columns() const {
    std::vector<std::string> bases{heading_base(data_.time)};
    if (data_.time.empty())
      bases.assign(kTimeHeadings.begin(), kTimeHeadings.end());
    std::vector<std::size_t> most;
    for (const std::string& base : bases) {
      std::vector<std::size_t> columns;
      for (std::size_t column = 0; column < file_.names.size(); ++column)
        if (heading_base(file_.names[column]) == base)
          columns.push_back(column);
      if (columns.size() > most.size())
        most = std::move(columns);
    }
    if (data_.layout != TableLayout::time_per_tag || most.size() > 1)
      return most;
    most.clear();
    for (std::size_t column = 0; column < file_.names.size(); ++column)
      if (first_cell_is(is_date, file_, column))
        most.push_back(column);
    return most;
  }

  // --- Stamps ---

  std::string place_of(std::size_t column) const {
    return fmt::format("{}: column '{}'", file_.file, shown_heading(file_.names[column]));
  }

  /// Reads a column of stamps. All such columns of a file must be of one kind.
  TimeStamps read_stamps(std::size_t column, const std::vector<std::string>& cells) {
    const std::string place = place_of(column);
    TimeStamps stamps = parse_time_stamps({place, cells, file_.lines}, rows_.rules);
    if (known_ && (stamps.calendar != rows_.calendar || stamps.unit != rows_.unit))
      throw InputError(place, "stamps of another kind than those of the columns before",
                       "columns of stamps that are all dates, or all numbers of one unit (data.time_unit)");
    if (!stamps.found.empty()) {
      warn(fmt::format("the time stamps are numbers that are taken for dates: data.time_unit = \"{}\"",
                       stamps.found));
      rows_.rules.unit = stamps.found;
    }
    if (rows_.rules.order == DateOrder::automatic)
      rows_.rules.order = stamps.order;
    known_ = true;
    rows_.calendar = stamps.calendar;
    rows_.unit = stamps.unit;
    return stamps;
  }

  RowsInTime ordered(std::size_t column, const std::vector<std::string>& cells, const TimeStamps& stamps) {
    return rows_in_time({place_of(column), cells, file_.lines}, stamps);
  }

  void warn(std::string text) { file_.warnings.push_back(std::move(text)); }

  // --- One row per time stamp ---

  std::optional<std::size_t> time_column() const {
    if (!data_.time.empty())
      return file_.column(file_.file + ": data.time", data_.time);
    for (const char* heading : kTimeHeadings)
      if (const auto column = file_.find(heading); column && may_be_stamps(*column))
        return column;
    if (const auto column = column_of_dates())
      return column;
    if (const auto column = column_of_dates_in_numbers())
      return column;
    return usual(kTimeHeadings);
  }

  /// Decides by the first cell, and by the study, which may use the column as a variable.
  bool may_be_stamps(std::size_t column) const {
    const std::string* const cell = first_cell(file_.columns[column]);
    const bool is_wanted =
        std::find(wanted_.names.begin(), wanted_.names.end(), file_.names[column]) != wanted_.names.end();
    return cell != nullptr && !is_wanted &&
           (!data_.time_format.empty() || file_.number(*cell) || is_date(*cell) || is_time_of_day(*cell));
  }

  /// Returns the only column of dates, whatever its heading is.
  std::optional<std::size_t> column_of_dates() const {
    std::optional<std::size_t> found;
    for (std::size_t column = 0; column < file_.names.size(); ++column) {
      if (!first_cell_is(is_date, file_, column))
        continue;
      if (found)
        throw InputError(fmt::format("{}: time stamps", file_.file),
                         fmt::format("dates in the columns '{}' and '{}'", shown_heading(file_.names[*found]),
                                     shown_heading(file_.names[column])),
                         "data.time, the column of the time stamps; data.layout = \"time-per-tag\" if each "
                         "column of values has its own");
      found = column;
    }
    return found;
  }

  /// Returns a column whose heading is empty or names a time, and whose numbers are recognised as dates.
  std::optional<std::size_t> column_of_dates_in_numbers() const {
    for (std::size_t column = 0; column < file_.names.size(); ++column) {
      const std::string base = heading_base(file_.names[column]);
      const bool of_time = std::any_of(kTimeWords.begin(), kTimeWords.end(), [&](const char* word) {
        return base.find(word) != std::string::npos;
      });
      if ((base.empty() || of_time) && are_dates_in_numbers(file_.columns[column], rows_.rules))
        return column;
    }
    return std::nullopt;
  }

  /// Returns the cells of the stamps: those of the column, or dates and times of day joined from two columns.
  std::vector<std::string> stamp_cells(std::size_t& column) const {
    const bool no_date = first_cell_is(is_time_of_day, file_, column);
    std::optional<std::size_t> dates;
    if (!data_.date.empty())
      dates = file_.column(file_.file + ": data.date", data_.date);
    else if (no_date)
      dates = column_of_dates();
    if (no_date && !dates)
      throw InputError(place_of(column), "times of day without a date",
                       "a column of dates beside it (data.date)");
    if (!no_date && !dates && data_.time.empty())
      if (const auto times = times_beside(column)) {
        dates = column;
        column = *times;
      }
    if (!dates)
      return file_.columns[column];
    std::vector<std::string> cells;
    for (std::size_t row = 0; row < file_.rows(); ++row)
      cells.push_back(joined(file_.columns[*dates][row], file_.columns[column][row]));
    return cells;
  }

  /// Returns the only column of times of day beside a column of dates whose own times are all midnight.
  std::optional<std::size_t> times_beside(std::size_t column) const {
    std::optional<std::size_t> found;
    for (std::size_t other = 0; other < file_.names.size(); ++other)
      if (first_cell_is(is_time_of_day, file_, other)) {
        if (found)
          return std::nullopt;
        found = other;
      }
    if (!found)
      return std::nullopt;
    const std::optional<std::vector<std::string>> english =
        dates_in_english(file_.columns[column], data_.language, place_of(column),
                         [](const std::string& cell) { return written_date(cell).has_value(); });
    const std::vector<std::string>& cells = english ? *english : file_.columns[column];
    const bool dates = std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
      const std::optional<WrittenDate> date = cell.empty() ? WrittenDate() : written_date(cell);
      return date && (!date->time || date->time->seconds == 0.0);
    });
    return dates ? found : std::nullopt;
  }

  /// Joins a date and a time of day. A time in the date itself (midnight) is dropped.
  static std::string joined(std::string date, const std::string& time) {
    if (const std::size_t colon = date.find(':'); colon != std::string::npos) {
      const std::size_t before = date.find_last_of(" T", colon);
      date.resize(before == std::string::npos ? 0 : before);
    }
    return date.empty() || time.empty() ? "" : date + " " + time;
  }

  void read_wide() {
    name_repeated_qualities(file_);
    std::optional<std::size_t> column = time_column();
    if (!column) {
      rows_.stamped = false;
      for (std::size_t row = 0; row < file_.rows(); ++row)
        rows_.times.push_back(static_cast<double>(row) * wanted_.sample_time);
      warn(fmt::format("no column of time stamps (data.time): each row is taken as one sample of {:g} {}",
                       wanted_.sample_time, wanted_.time_unit));
      rows_.file = std::move(file_);
      return;
    }
    const std::vector<std::string> cells = stamp_cells(*column);
    const TimeStamps stamps = read_stamps(*column, cells);
    const RowsInTime in_time = ordered(*column, cells, stamps);
    require_rows(in_time.rows.size());
    if (in_time.without > 0)
      warn(fmt::format("{} rows without a time stamp are left out", in_time.without));
    if (in_time.turned)
      warn("the newest row comes first: the rows are reversed");
    warn_of_doubles(in_time.doubles);
    for (const std::size_t row : in_time.rows)
      rows_.times.push_back(stamps.times[row]);
    if (in_time.without > 0 || in_time.turned)
      file_.keep_rows(in_time.rows);
    rows_.file = std::move(file_);
  }

  void require_rows(std::size_t rows) const {
    if (rows == 0)
      throw InputError(file_.file + ": time stamps", "none", "a stamp in each row");
  }

  void warn_of_doubles(std::size_t doubles) {
    if (doubles > 0)
      warn(
          fmt::format("{} rows have the time stamp of the row before them; a CV is their mean, everything "
                      "else the last one",
                      doubles));
  }

  // --- Time stamps for each tag ---

  void read_time_per_tag() {
    const std::vector<std::size_t> of_stamps = stamp_columns();
    if (of_stamps.empty())
      throw InputError(fmt::format("{}: data.layout", file_.file), "no column of stamps",
                       "a column of stamps before each column of values (data.time is their heading)");
    std::vector<StampedSeries> all;
    std::vector<std::vector<double>> times;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < of_stamps.size(); ++i) {
      const std::size_t column = of_stamps[i];
      const TimeStamps stamps = read_stamps(column, file_.columns[column]);
      StampedSeries series;
      series.rows = ordered(column, file_.columns[column], stamps).rows;
      const std::size_t end = i + 1 < of_stamps.size() ? of_stamps[i + 1] : file_.names.size();
      for (std::size_t value = column + 1; value < end; ++value) {
        series.parts.push_back({names.size(), value});
        names.push_back(name_of_part(column + 1, value));
      }
      all.push_back(std::move(series));
      times.push_back(stamps.times);
    }
    merge(
        all, [&](std::size_t series, std::size_t row) { return times[series][row]; }, std::move(names));
  }

  /// Names a column. A heading that recurs for other tags gets the tag before it: "TAG.status".
  std::string name_of_part(std::size_t tag, std::size_t column) const {
    const std::string& name = file_.names[column];
    const bool again = std::count(file_.names.begin(), file_.names.end(), name) > 1;
    return column > tag && again ? fmt::format("{}.{}", file_.names[tag], name) : name;
  }

  // --- One row per value ---

  std::size_t long_column(const char* key, const std::string& named,
                          const std::optional<std::size_t>& found) const {
    const std::string place = fmt::format("{}: data.{}", file_.file, key);
    if (!named.empty())
      return file_.column(place, named);
    if (!found)
      throw InputError(place, "no column of a usual name",
                       "the name of the column, in a file in which each row is a value");
    return *found;
  }

  void read_long() {
    const std::size_t tags = long_column("tag_column", data_.tag_column, usual(kTagHeadings));
    const std::size_t values = long_column("value_column", data_.value_column, usual(kValueHeadings));
    std::optional<std::size_t> column = time_column();
    if (!column)
      throw InputError(fmt::format("{}: time stamps", file_.file), "none",
                       "a column of them (data.time), in a file in which each row is a value");
    const std::vector<std::string> cells = stamp_cells(*column);
    const TimeStamps stamps = read_stamps(*column, cells);
    std::map<std::string, std::vector<std::size_t>> by_tag;
    for (std::size_t row = 0; row < file_.rows(); ++row)
      if (const std::string& tag = file_.columns[tags][row]; !tag.empty())
        by_tag[tag].push_back(row);
    require_tags(by_tag.size(), tags);
    std::vector<StampedSeries> all;
    std::vector<std::string> names;
    for (const auto& [tag, rows] : by_tag) {
      StampedSeries series = of_tag(*column, stamps, rows);
      for (std::size_t part = 0; part < file_.names.size(); ++part) {
        if (part == tags || part == *column)
          continue;
        series.parts.push_back({names.size(), part});
        names.push_back(part == values ? tag : fmt::format("{}.{}", tag, file_.names[part]));
      }
      all.push_back(std::move(series));
    }
    merge(
        all, [&](std::size_t, std::size_t row) { return stamps.times[row]; }, std::move(names));
  }

  void require_tags(std::size_t count, std::size_t column) const {
    constexpr std::size_t kMostTags = 10000;
    if (count == 0 || count > kMostTags)
      throw InputError(place_of(column), fmt::format("{} tags", count),
                       fmt::format("1 to {}; data.tag_column names another column", kMostTags));
  }

  /// Returns the rows of one tag in the order of their stamps.
  StampedSeries of_tag(std::size_t column, const TimeStamps& stamps, const std::vector<std::size_t>& rows) {
    TimeStamps of_tag = {.calendar = stamps.calendar,
                         .offsets = stamps.offsets,
                         .unit = {},
                         .found = {},
                         .order = {},
                         .times = {}};
    std::vector<std::size_t> lines;
    for (const std::size_t row : rows) {
      of_tag.times.push_back(stamps.times[row]);
      lines.push_back(file_.lines[row]);
    }
    StampedSeries series;
    for (const std::size_t place : rows_in_time({place_of(column), {}, lines}, of_tag).rows)
      series.rows.push_back(rows[place]);
    return series;
  }

  /// Merges series with separate stamps into common rows. time_of(series, row) is the stamp of a row of the
  /// file.
  template <class TimeOf>
  void merge(const std::vector<StampedSeries>& all, TimeOf time_of, std::vector<std::string> names) {
    std::map<std::pair<double, std::size_t>, std::size_t> places;  // time, and how often it occurred before
    std::vector<std::vector<std::pair<double, std::size_t>>> keys(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const std::size_t row : all[i].rows) {
        const double time = time_of(i, row);
        const bool again = !keys[i].empty() && keys[i].back().first == time;
        keys[i].emplace_back(time, again ? keys[i].back().second + 1 : 0);
        places.emplace(keys[i].back(), 0);
      }
    require_rows(places.size());
    require_cells(places.size(), names.size());
    std::size_t count = 0, doubles = 0;
    for (auto& [key, place] : places) {
      place = count++;
      rows_.times.push_back(key.first);
      doubles += key.second > 0 ? 1 : 0;
    }
    RecordColumns made = without_rows(std::move(names), count);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < keys[i].size(); ++k) {
        const std::size_t from = all[i].rows[k], to = places[keys[i][k]];
        made.lines[to] =
            made.lines[to] == 0 ? file_.lines[from] : std::min(made.lines[to], file_.lines[from]);
        for (const StampedSeries::Part& part : all[i].parts)
          made.columns[part.column][to] = std::move(file_.columns[part.source][from]);
      }
    warn_of_doubles(doubles);
    made.warnings = std::move(file_.warnings);
    rows_.file = std::move(made);
  }

  void require_cells(std::size_t rows, std::size_t columns) const {
    if (rows > kMostForeignCells / std::max<std::size_t>(columns, 1))
      throw InputError(file_.file, fmt::format("{} time stamps of {} columns", rows, columns),
                       fmt::format("at most {} cells: a shorter period, or fewer tags", kMostForeignCells));
  }

  RecordColumns without_rows(std::vector<std::string> names, std::size_t rows) const {
    RecordColumns made;
    made.file = file_.file;
    made.separator = file_.separator;
    made.decimal = file_.decimal;
    made.group = file_.group;
    made.left_out = file_.left_out;
    made.columns.assign(names.size(), std::vector<std::string>(rows));
    made.names = std::move(names);
    made.lines.assign(rows, 0);
    return made;
  }

  static constexpr std::array kTimeWords{"time", "date", "stamp", "zeit", "epoch", "datum"};

  const DataOptions& data_;
  const RowsWanted& wanted_;
  RecordColumns file_;
  StampedRows rows_;
  bool known_ = false;  ///< the kind of the stamps is known
};

}  // namespace

std::string StampedRows::text(double time) const {
  return calendar ? date_text(time) : fmt::format("{:.15g}", time);
}

StampedRows stamped_rows(const RowsWanted& wanted, RecordColumns file) {
  return RowsReader(wanted, std::move(file)).rows();
}

}  // namespace mpm
