#include "results/records/time_stamps.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>

#include <date/date.h>
#include <fmt/format.h>

#include "analysis/findings/monitored_loop.hpp"
#include "analysis/statistics/quantile.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/date_words.hpp"
#include "results/records/written_date.hpp"
#include "results/records/zone_clock.hpp"

namespace mpm {
namespace {

constexpr double kSecondsOfDay = 86400.0;
constexpr double kEarliestDate = -62167305600.0, kLatestDate = 253402387200.0;  // years 0 to 9999 +- one day
constexpr const char* kForms =
    "numbers, or dates such as 2024-10-27 02:59:30, 2024-10-27T02:59:30Z, 27.10.2024 02:59, 10/27/2024 2:59 "
    "PM, 27-Oct-24 02:59:30, with months of any language; data.time_unit or data.time_format for others";

using Dates = std::vector<std::optional<WrittenDate>>;

[[noreturn]] void refuse_stamp(const StampSource& source, std::size_t row, const std::string& allowed) {
  const std::size_t line = source.lines[row];  // 0: not from a file
  throw InputError(line == 0 ? source.where : fmt::format("{}, line {}", source.where, line),
                   fmt::format("'{}'", cut_utf8(source.cells[row], kShownBytes)), allowed);
}

std::optional<double> number_in_stamp(std::string cell, char decimal) {
  if (decimal == ',')
    std::replace(cell.begin(), cell.end(), ',', '.');
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

// --- Numbers ---

struct EpochUnit {
  const char* name;
  double in_second;
};

constexpr EpochUnit kEpochUnits[] = {{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}};

struct StampRange {
  double low, high;
  /// Tells whether there are values and all of them are in the range; NaN does not count.
  bool has_all(const std::vector<double>& values, double scale = 1.0) const {
    std::size_t inside = 0, there = 0;
    for (const double value : values) {
      there += std::isnan(value) ? 0 : 1;
      inside += value >= low * scale && value < high * scale ? 1 : 0;
    }
    return there > 0 && inside == there;
  }
};

constexpr StampRange kEpoch{631152000.0, 4102444800.0};  // 1990 to 2099, s since 1970

/// A program that counts days, and its count for 1970-01-01.
struct DayCount {
  const char* name;
  double of_1970;
};

constexpr DayCount kDayCounts[] = {{"spreadsheet", 25569.0}, {"matlab", 719529.0}};
constexpr StampRange kDaysOfDates{10957.0, 47482.0};  // 2000 to 2099, days since 1970

double median_step(std::vector<double> values) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < values.size(); ++row)
    if (const double step = std::abs(values[row] - values[row - 1]); step > 0.0)
      steps.push_back(step);
  return steps.empty() ? 0.0 : upper_median(std::move(steps));
}

/// Tells whether the steps suit the controller as days but are far too short for it in the unit of the plant.
bool have_steps_of_days(const std::vector<double>& values, const StampRules& rules) {
  constexpr double kLongestStep = 10.0, kFarTooShort = 0.01;
  const double step = median_step(values);
  return rules.sample_days > 0.0 && step > 0.0 && step <= kLongestStep * rules.sample_days &&
         step < kFarTooShort * rules.sample;
}

/// Converts days to stamps, rounded to milliseconds: a spreadsheet has no more digits.
TimeStamps from_days(std::vector<double> days, const DayCount& count, bool found) {
  constexpr double kMilliseconds = 1000.0;
  for (double& day : days)
    day = std::round((day - count.of_1970) * kSecondsOfDay * kMilliseconds) / kMilliseconds;
  return {.calendar = true,
          .offsets = false,
          .unit = "s",
          .found = found ? count.name : "",
          .order = DateOrder::automatic,
          .times = std::move(days)};
}

TimeStamps from_numbers(std::vector<double> values, const StampRules& rules) {
  for (const DayCount& count : kDayCounts) {
    const StampRange range{kDaysOfDates.low + count.of_1970, kDaysOfDates.high + count.of_1970};
    const bool found = rules.unit.empty() && range.has_all(values) && have_steps_of_days(values, rules);
    if (found || rules.unit == count.name)
      return from_days(std::move(values), count, found);
  }
  TimeStamps stamps;
  stamps.unit = rules.unit;
  for (const EpochUnit& unit : kEpochUnits) {
    stamps.calendar =
        kEpoch.has_all(values, unit.in_second) && (rules.unit.empty() || rules.unit == unit.name);
    if (!stamps.calendar && rules.unit != unit.name)
      continue;
    stamps.offsets = stamps.calendar;
    stamps.unit = "s";
    stamps.found = rules.unit.empty() ? unit.name : "";
    if (unit.in_second != 1.0)
      for (double& value : values)
        value /= unit.in_second;
    break;
  }
  stamps.times = std::move(values);
  return stamps;
}

// --- Dates ---

/// Returns the order of day, month and year that the stamps themselves show.
DateOrder shown_order(const StampSource& source, const Dates& dates) {
  bool day_first = false, month_first = false, points = false;
  const std::string* example = nullptr;
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row] || dates[row]->resolved)
      continue;
    if (dates[row]->first > 31)
      return DateOrder::year_month_day;
    example = example == nullptr ? &source.cells[row] : example;
    points = points || dates[row]->points;
    day_first = day_first || dates[row]->first > 12;
    month_first = month_first || dates[row]->second > 12;
  }
  if (example == nullptr)
    return DateOrder::year_month_day;
  if (day_first != month_first)
    return day_first ? DateOrder::day_month_year : DateOrder::month_day_year;
  if (points && !month_first)
    return DateOrder::day_month_year;
  throw InputError(source.where,
                   fmt::format("dates such as '{}', in which day and month cannot be told apart", *example),
                   "data.date_order = \"day-month-year\" or \"month-day-year\" in the study file");
}

bool has_offset(const WrittenTime& time) {
  return time.offset || !time.zone.empty();
}

/// Refuses mixed forms: otherwise some stamps could be hours off without a message.
void refuse_mixed_forms(const StampSource& source, const Dates& dates) {
  const std::optional<WrittenDate>* first = nullptr;
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row] || !dates[row]->time)
      continue;
    if (first == nullptr)
      first = &dates[row];
    const WrittenTime &here = *dates[row]->time, &before = *(*first)->time;
    if (has_offset(here) != has_offset(before))
      refuse_stamp(source, row, "stamps that all have their offset from UTC (or Z), or none of them");
    if (here.twelve_hours != before.twelve_hours)
      refuse_stamp(source, row, "stamps that all have AM or PM, or none of them");
  }
}

/// Converts the times that the clock of a zone shows to UTC, row by row.
class LocalTimes {
 public:
  LocalTimes(const StampSource& source, const std::string& zone) : source_(source), name_(zone) {
    if (!zone.empty())
      clock_.emplace(zone, "data.time_zone");
  }

  double utc(std::size_t row, double local, const std::string& letters) {
    if (!clock_)
      return letters.empty() ? local : local - offset(row, letters);
    const std::optional<double> time = clock_->utc(local, letters, latest_);
    if (!time)
      refuse_stamp(source_, row,
                   fmt::format("a time that the clocks of {} (data.time_zone) show{}", name_,
                               letters.empty() ? "" : fmt::format(", with the letters '{}'", letters)));
    latest_ = *time;
    return *time;
  }

 private:
  double offset(std::size_t row, const std::string& letters) const {
    const std::optional<double> known = offset_of_letters(letters);
    if (!known)
      refuse_stamp(source_, row,
                   fmt::format("Z, an offset such as +01:00, or letters of one zone alone, such as CET; "
                               "data.time_zone = \"Europe/Berlin\" says to which zone '{}' belongs",
                               cut_utf8(letters, kShownBytes)));
    return *known;
  }

  const StampSource& source_;
  std::string name_;
  std::optional<ZoneClock> clock_;
  double latest_ = -kInfinity;
};

/// Returns the rows from the earliest to the latest; the stamps must ascend or descend.
std::vector<std::size_t> rows_in_time(const std::vector<double>& times) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < times.size(); ++row)
    if (!std::isnan(times[row]))
      rows.push_back(row);
  if (!rows.empty() && times[rows.front()] > times[rows.back()])
    std::reverse(rows.begin(), rows.end());
  return rows;
}

TimeStamps from_dates(const StampSource& source, const Dates& dates, const StampRules& rules) {
  refuse_mixed_forms(source, dates);
  const DateOrder order = rules.order == DateOrder::automatic ? shown_order(source, dates) : rules.order;
  TimeStamps stamps{.calendar = true, .offsets = true, .unit = "s", .found = {}, .order = order, .times = {}};
  stamps.times.assign(dates.size(), kNaN);
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row])
      continue;
    const std::optional<double> days = days_of(*dates[row], order);
    if (!days)
      refuse_stamp(source, row, "a day that exists, in the order data.date_order");
    const std::optional<WrittenTime>& time = dates[row]->time;
    stamps.offsets = stamps.offsets && time && has_offset(*time);
    stamps.times[row] = kSecondsOfDay * *days + (time ? time->seconds - time->offset.value_or(0.0) : 0.0);
  }
  LocalTimes local(source, rules.zone);
  for (const std::size_t row : rows_in_time(stamps.times)) {
    const std::optional<WrittenTime>& time = dates[row]->time;
    if (!time || !time->offset)
      stamps.times[row] = local.utc(row, stamps.times[row], time ? time->zone : "");
  }
  stamps.offsets = stamps.offsets || !rules.zone.empty();
  return stamps;
}

/// A date in the format that the study gives.
struct FormattedDate {
  double seconds = kNaN;  ///< since 1970, minus the offset if there is one
  bool has_offset = false;
  std::string letters;  ///< letters of a zone
};

/// Reads a cell in this format; none unless the whole cell can be read.
std::optional<FormattedDate> formatted_date(const std::string& cell, const std::string& format) {
  using LocalTime = date::local_time<std::chrono::microseconds>;
  constexpr double kMicroseconds = 1e6;
  constexpr std::chrono::minutes kNoOffset(10000);
  std::istringstream in(cell);
  LocalTime time{};
  FormattedDate found;
  std::chrono::minutes offset = kNoOffset;
  date::from_stream(in, format.c_str(), time, &found.letters, &offset);
  if (in.fail() || in.peek() != std::istringstream::traits_type::eof())
    return std::nullopt;
  found.has_offset = offset != kNoOffset;
  found.seconds = static_cast<double>(time.time_since_epoch().count()) / kMicroseconds -
                  (found.has_offset ? 60.0 * static_cast<double>(offset.count()) : 0.0);
  return found;
}

TimeStamps in_format(const StampSource& source, const StampRules& rules) {
  TimeStamps stamps{
      .calendar = true, .offsets = true, .unit = "s", .found = {}, .order = rules.order, .times = {}};
  stamps.times.assign(source.cells.size(), kNaN);
  const auto english = dates_in_english(
      source.cells, rules.language, source.where,
      [&rules](const std::string& cell) { return formatted_date(cell, rules.format).has_value(); });
  const std::vector<std::string>& cells = english ? *english : source.cells;
  std::vector<FormattedDate> dates(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    if (cells[row].empty())
      continue;
    const std::optional<FormattedDate> date = formatted_date(cells[row], rules.format);
    if (!date)
      refuse_stamp(source, row, fmt::format("dates of the form '{}' (data.time_format)", rules.format));
    dates[row] = *date;
    stamps.offsets = stamps.offsets && (date->has_offset || !date->letters.empty());
    stamps.times[row] = date->seconds;
  }
  LocalTimes local(source, rules.zone);
  for (const std::size_t row : rows_in_time(stamps.times))
    if (!dates[row].has_offset)
      stamps.times[row] = local.utc(row, stamps.times[row], dates[row].letters);
  stamps.offsets = stamps.offsets || !rules.zone.empty();
  return stamps;
}

/// Reads dates that consist of digits alone; none if any cell is no such date.
std::optional<Dates> compact_dates(const std::vector<std::string>& cells) {
  Dates dates(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    if (cells[row].empty())
      continue;
    dates[row] = compact_date(cells[row]);
    if (!dates[row])
      return std::nullopt;
  }
  return dates;
}

/// The cells read one by one: all of them, or those before the first that is neither a number nor a date.
struct ReadCells {
  std::vector<double> numbers;
  Dates dates;
  bool has_numbers = false, has_dates = false;
  std::optional<std::size_t> refused;
};

ReadCells read_cells(const StampSource& source, const std::vector<std::string>& cells, char decimal) {
  ReadCells read{
      .numbers = std::vector<double>(cells.size(), kNaN), .dates = Dates(cells.size()), .refused = {}};
  for (std::size_t row = 0; row < cells.size(); ++row) {
    if (cells[row].empty())
      continue;
    const std::optional<double> number = number_in_stamp(cells[row], decimal);
    read.numbers[row] = number.value_or(kNaN);
    read.dates[row] = number ? std::nullopt : written_date(cells[row]);
    if (!number && !read.dates[row]) {
      read.refused = row;
      return read;
    }
    read.has_numbers = read.has_numbers || number;
    read.has_dates = read.has_dates || read.dates[row];
    if (read.has_numbers && read.has_dates)
      refuse_stamp(source, row, "stamps of one form: all dates, or all numbers");
  }
  return read;
}

TimeStamps stamps_in(const StampSource& source, const StampRules& rules) {
  if (!rules.format.empty())
    return in_format(source, rules);
  if (rules.unit.empty())
    if (const std::optional<Dates> compact = compact_dates(source.cells);
        compact && std::any_of(compact->begin(), compact->end(), [](const auto& date) { return date; }))
      return from_dates(source, *compact, rules);
  ReadCells read = read_cells(source, source.cells, rules.decimal);
  if (read.refused || !rules.language.empty())
    if (const auto english =
            dates_in_english(source.cells, rules.language, source.where,
                             [](const auto& cell) { return written_date(cell).has_value(); }))
      read = read_cells(source, *english, rules.decimal);
  if (read.refused)
    refuse_stamp(source, *read.refused, kForms);
  return read.has_dates ? from_dates(source, read.dates, rules)
                        : from_numbers(std::move(read.numbers), rules);
}

}  // namespace

StampRules stamp_rules(const DataOptions& data, char decimal, double sample_time,
                       const std::string& time_unit) {
  return {.order = data.date_order,
          .decimal = decimal,
          .unit = data.time_unit,
          .format = data.time_format,
          .zone = data.time_zone,
          .language = data.language,
          .sample_days = sample_time * days_in(time_unit).value_or(0.0),
          .sample = sample_time};
}

TimeStamps parse_time_stamps(const StampSource& source, const StampRules& rules) {
  TimeStamps stamps = stamps_in(source, rules);
  if (stamps.calendar)
    for (std::size_t row = 0; row < stamps.times.size(); ++row)
      if (stamps.times[row] < kEarliestDate || stamps.times[row] >= kLatestDate)
        refuse_stamp(source, row, "a time of the years 0 to 9999 (data.time_unit)");
  return stamps;
}

bool are_dates_in_numbers(const std::vector<std::string>& cells, const StampRules& rules) {
  if (const std::optional<Dates> compact = compact_dates(cells))
    return std::any_of(compact->begin(), compact->end(), [](const auto& date) { return date.has_value(); });
  std::vector<double> numbers;
  for (const std::string& cell : cells) {
    const std::optional<double> number = cell.empty() ? kNaN : number_in_stamp(cell, rules.decimal);
    if (!number)
      return false;
    numbers.push_back(*number);
  }
  return from_numbers(std::move(numbers), rules).calendar;
}

std::string date_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::floor(seconds));
  const std::int64_t days = static_cast<std::int64_t>(std::floor(static_cast<double>(whole) / kSecondsOfDay));
  const std::int64_t of_day = whole - 86400 * days;
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(days))};
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), of_day / 3600,
                     of_day / 60 % 60, of_day % 60);
}

}  // namespace mpm
