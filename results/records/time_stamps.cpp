#include "results/records/time_stamps.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <regex>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

constexpr const char* kForms =
    "numbers, or dates such as 2024-10-27 02:59:30, 2024-10-27T02:59:30Z, 27.10.2024 02:59, 10/27/2024 2:59 "
    "PM";

/// A stamp as it stands: three numbers of the date in their order, and the time of day with its offset.
struct WrittenDate {
  int first = 0, second = 0, third = 0;
  double seconds = 0.0;       ///< since midnight, the offset taken off
  bool offset = false;        ///< it had one
  bool time_of_day = false;   ///< it had one
  bool twelve_hours = false;  ///< AM or PM
};

std::optional<double> number_in(std::string cell, char decimal) {
  if (decimal == ',')
    std::replace(cell.begin(), cell.end(), ',', '.');
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

/// "+01:00" in s; none for one that no clock has.
std::optional<double> offset_of(const std::string& text) {
  if (text.empty() || text == "Z" || text == "z")
    return 0.0;
  const double hours = std::stod(text.substr(1, 2));
  const double minutes = text.size() > 3 ? std::stod(text.substr(text.size() - 2)) : 0.0;
  constexpr double kMostHours = 14.0;
  if (minutes > 59.0 || hours + minutes / 60.0 > kMostHours)
    return std::nullopt;
  return (text[0] == '-' ? -1.0 : 1.0) * (3600.0 * hours + 60.0 * minutes);
}

std::optional<WrittenDate> date_in(const std::string& cell) {
  static const std::regex form(
      R"((\d{1,4})[-./](\d{1,2})[-./](\d{1,4})(?:[T ]+(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,](\d{1,9}))?)?\s*([AaPp][Mm])?\s*(Z|z|[+-]\d{2}:?(?:\d{2})?)?)?)");
  std::smatch part;
  if (cell.size() > 64 || !std::regex_match(cell, part, form))
    return std::nullopt;
  WrittenDate date{std::stoi(part[1]), std::stoi(part[2]), std::stoi(part[3])};
  if (!part[4].matched)
    return date;
  int hour = std::stoi(part[4]);
  date.time_of_day = true;
  date.twelve_hours = part[8].matched;
  if (date.twelve_hours && (hour < 1 || hour > 12))
    return std::nullopt;
  if (date.twelve_hours)
    hour = hour % 12 + (std::tolower(part[8].str()[0]) == 'p' ? 12 : 0);
  const int minute = std::stoi(part[5]);
  const double second = (part[6].matched ? std::stod(part[6]) : 0.0) +
                        (part[7].matched ? std::stod(fmt::format("0.{}", part[7].str())) : 0.0);
  const bool end_of_day = hour == 24 && minute == 0 && second == 0.0;
  const std::optional<double> offset = offset_of(part[9]);
  if ((hour > 23 && !end_of_day) || minute > 59 || second > 60.0 || !offset)
    return std::nullopt;
  date.offset = part[9].matched;
  date.seconds = 3600.0 * hour + 60.0 * minute + second - *offset;
  return date;
}

/// The order that the stamps themselves show.
DateOrder shown_order(const StampSource& source, const std::vector<std::optional<WrittenDate>>& dates) {
  bool day_first = false, month_first = false, points = false;
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row])
      continue;
    if (dates[row]->first > 31)
      return DateOrder::year_month_day;
    points = points || source.cells[row].find('.') < source.cells[row].find(':');
    day_first = day_first || dates[row]->first > 12;
    month_first = month_first || dates[row]->second > 12;
  }
  if (day_first != month_first)
    return day_first ? DateOrder::day_month_year : DateOrder::month_day_year;
  if (points && !month_first)
    return DateOrder::day_month_year;
  throw InputError(
      source.where,
      fmt::format("dates such as '{}', whose day and month nothing tells apart", source.cells.front()),
      "data.date_order = \"day-month-year\" or \"month-day-year\" in the study file");
}

/// Days since 1970 (std::chrono knows which days there are).
std::optional<double> days_of(const WrittenDate& date, DateOrder order) {
  const bool year_first = order == DateOrder::year_month_day;
  const int year = year_first ? date.first : date.third;
  const int month = order == DateOrder::month_day_year ? date.first : date.second;
  const int day = year_first ? date.third : order == DateOrder::month_day_year ? date.second : date.first;
  const std::chrono::year_month_day of_calendar{std::chrono::year(year < 100 ? year + 2000 : year),
                                                std::chrono::month(static_cast<unsigned>(month)),
                                                std::chrono::day(static_cast<unsigned>(day))};
  if (!of_calendar.ok())
    return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(of_calendar).time_since_epoch().count());
}

[[noreturn]] void refuse_stamp(const StampSource& source, std::size_t row, const char* allowed) {
  throw InputError(fmt::format("{}, line {}", source.where, source.lines[row]),
                   fmt::format("'{}'", cut_utf8(source.cells[row], kShownBytes)), allowed);
}

/// An hour that some stamps mean in another way than the others moves these without a word.
void refuse_mixed_forms(const StampSource& source, const std::vector<std::optional<WrittenDate>>& dates) {
  const std::optional<WrittenDate>* first = nullptr;
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row] || !dates[row]->time_of_day)
      continue;
    if (first == nullptr)
      first = &dates[row];
    if (dates[row]->offset != (*first)->offset)
      refuse_stamp(source, row, "stamps that all have their offset from UTC (or Z), or none of them");
    if (dates[row]->twelve_hours != (*first)->twelve_hours)
      refuse_stamp(source, row, "stamps that all have AM or PM, or none of them");
  }
}

}  // namespace

bool is_date(const std::string& cell) {
  return date_in(cell).has_value();
}

TimeStamps parse_time_stamps(const StampSource& source, DateOrder order, char decimal) {
  TimeStamps stamps;
  stamps.times.assign(source.cells.size(), kNaN);
  std::vector<std::optional<WrittenDate>> dates(source.cells.size());
  bool numbers = false;
  for (std::size_t row = 0; row < source.cells.size(); ++row) {
    const std::string& cell = source.cells[row];
    if (cell.empty())
      continue;
    const std::optional<double> number = number_in(cell, decimal);
    dates[row] = number ? std::nullopt : date_in(cell);
    if (number)
      stamps.times[row] = *number;
    else if (!dates[row])
      refuse_stamp(source, row, kForms);
    numbers = numbers || number.has_value();
    stamps.calendar = stamps.calendar || dates[row].has_value();
    if (numbers && stamps.calendar)
      refuse_stamp(source, row, "stamps of one form: all dates, or all numbers");
  }
  if (!stamps.calendar)
    return stamps;
  refuse_mixed_forms(source, dates);
  const DateOrder of_all = order == DateOrder::automatic ? shown_order(source, dates) : order;
  stamps.offsets = true;
  for (std::size_t row = 0; row < dates.size(); ++row) {
    if (!dates[row])
      continue;
    stamps.offsets = stamps.offsets && dates[row]->offset;
    const std::optional<double> days = days_of(*dates[row], of_all);
    if (!days)
      refuse_stamp(source, row, "a day that there is, in the order data.date_order");
    stamps.times[row] = 86400.0 * *days + dates[row]->seconds;
  }
  return stamps;
}

std::string date_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::floor(seconds));
  const std::int64_t days = static_cast<std::int64_t>(std::floor(static_cast<double>(whole) / 86400.0));
  const std::int64_t of_day = whole - 86400 * days;
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(days))};
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), of_day / 3600,
                     of_day / 60 % 60, of_day % 60);
}

}  // namespace mpm
