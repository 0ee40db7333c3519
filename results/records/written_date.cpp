#include "results/records/written_date.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <utility>

namespace mpm {
namespace {

constexpr std::size_t kLongestDate = 64;
constexpr double kSecondsOfMinute = 60.0;
constexpr double kSecondsOfClockHour = 3600.0;

/// Reads a cell from left to right.
class DateScanner {
 public:
  explicit DateScanner(std::string_view text) : text_(text) {}

  bool at_end() const { return text_.empty(); }
  char next() const { return text_.empty() ? '\0' : text_.front(); }
  bool digit_next() const { return std::isdigit(static_cast<unsigned char>(next())) != 0; }

  /// Takes one of these signs; returns '\0' if none of them comes next.
  char sign(std::string_view allowed) {
    if (text_.empty() || allowed.find(text_.front()) == std::string_view::npos)
      return '\0';
    const char found = text_.front();
    text_.remove_prefix(1);
    return found;
  }

  bool blanks() {
    const std::size_t before = text_.size();
    text_.remove_prefix(std::min(text_.find_first_not_of(' '), text_.size()));
    return text_.size() < before;
  }

  /// Takes all digits that come next, if there are `least` to `most` of them.
  std::string_view digits(std::size_t least, std::size_t most) {
    const std::size_t count = std::min(text_.find_first_not_of("0123456789"), text_.size());
    return count < least || count > most ? std::string_view() : take(count);
  }

  /// Takes digits in the same way and returns their number.
  std::optional<int> number(std::size_t least, std::size_t most) {
    const std::string_view found = digits(least, most);
    int value = 0;
    std::from_chars(found.data(), found.data() + found.size(), value);
    return found.empty() ? std::nullopt : std::optional(value);
  }

  /// Takes all letters that come next, including those of other scripts.
  std::string_view letters() {
    std::size_t count = 0;
    while (count < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[count])) != 0 ||
                                    static_cast<unsigned char>(text_[count]) >= 0x80))
      ++count;
    return take(count);
  }

 private:
  std::string_view take(std::size_t count) {
    const std::string_view taken = text_.substr(0, count);
    text_.remove_prefix(count);
    return taken;
  }

  std::string_view text_;
};

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Returns the position of a word among names. A name matches in full or by its first three letters.
template <std::size_t size>
std::optional<int> place_among(std::string_view word, const std::array<std::string_view, size>& names) {
  constexpr std::size_t kShort = 3;
  for (std::size_t i = 0; i < size; ++i)
    if (same_letters(word, names[i]) || same_letters(word, names[i].substr(0, kShort)))
      return static_cast<int>(i);
  return std::nullopt;
}

std::optional<int> month_of(std::string_view word) {
  static constexpr std::array<std::string_view, 12> kEnglish{"january",   "february", "march",    "april",
                                                             "may",       "june",     "july",     "august",
                                                             "september", "october",  "november", "december"};
  static constexpr std::array<std::string_view, 12> kGerman{"januar",    "februar", "mrz",      "april",
                                                            "mai",       "juni",    "juli",     "august",
                                                            "september", "oktober", "november", "dezember"};
  std::optional<int> place = place_among(word, kEnglish);
  if (!place)
    place = place_among(word, kGerman);
  if (!place && (word == "M\xC3\xA4r" || word == "M\xC3\xA4rz" || same_letters(word, "sept")))
    place = same_letters(word, "sept") ? 8 : 2;
  return place ? std::optional(*place + 1) : std::nullopt;
}

bool is_day_of_week(std::string_view word) {
  static constexpr std::array<std::string_view, 14> kDays{
      "monday", "tuesday",  "wednesday", "thursday",   "friday",  "saturday", "sunday",
      "montag", "dienstag", "mittwoch",  "donnerstag", "freitag", "samstag",  "sonntag"};
  return place_among(word, kDays).has_value();
}

/// Reads "+01:00", "+0100" or "+01" after its sign, as s; none if no clock has this offset.
std::optional<double> read_offset(DateScanner& scan, char sign) {
  constexpr double kMostHours = 14.0;
  constexpr int kHundred = 100;
  std::optional<int> hours = scan.number(2, 2);
  int minutes = 0;
  if (!hours) {
    hours = scan.number(4, 4);
    if (!hours)
      return std::nullopt;
    minutes = *hours % kHundred;
    *hours /= kHundred;
  } else if (scan.sign(":") != '\0') {
    minutes = scan.number(2, 2).value_or(kHundred);
  }
  if (minutes > 59 || *hours + minutes / kSecondsOfMinute > kMostHours)
    return std::nullopt;
  return (sign == '-' ? -1.0 : 1.0) * (kSecondsOfClockHour * *hours + kSecondsOfMinute * minutes);
}

/// Reads everything after a time of day; false if something does not belong there. AM and PM change the hour.
bool read_zone(DateScanner& scan, WrittenTime& time, int& hour) {
  scan.blanks();
  if (std::string_view word = scan.letters(); !word.empty()) {
    if (same_letters(word, "am") || same_letters(word, "pm")) {
      if (hour < 1 || hour > 12)
        return false;
      time.twelve_hours = true;
      hour = hour % 12 + (std::tolower(word[0]) == 'p' ? 12 : 0);
      scan.blanks();
      word = scan.letters();
    }
    if (same_letters(word, "z"))
      time.offset = 0.0;
    else if (std::all_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; }))
      time.zone = word;
    else
      return false;
  }
  if (const char sign = scan.sign("+-"); sign != '\0') {
    time.offset = read_offset(scan, sign);
    if (!time.offset || !(time.zone.empty() || time.zone == "UTC" || time.zone == "GMT"))
      return false;
    time.zone.clear();
  }
  return scan.at_end();
}

/// Reads the fraction of a second, if one comes next.
double read_fraction(DateScanner& scan) {
  if (scan.sign(".,") == '\0')
    return 0.0;
  const std::string text = "0." + std::string(scan.digits(1, 9));
  double fraction = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), fraction);
  return fraction;
}

/// Reads h:mm, h:mm:ss.f, hhmm or hhmmss, and everything after it.
std::optional<WrittenTime> read_time(DateScanner& scan, bool basic) {
  std::optional<int> hour, minute, second = 0;
  bool fraction = false;
  if (basic) {
    const std::string_view digits = scan.digits(4, 6);
    if (digits.size() != 4 && digits.size() != 6)
      return std::nullopt;
    DateScanner of_hour(digits.substr(0, 2)), of_minute(digits.substr(2, 2)), of_second(digits.substr(4));
    hour = of_hour.number(2, 2);
    minute = of_minute.number(2, 2);
    second = of_second.number(2, 2).value_or(0);
    fraction = digits.size() == 6;
  } else {
    hour = scan.number(1, 2);
    if (scan.sign(":") != '\0')
      minute = scan.number(2, 2);
    if (minute && scan.sign(":") != '\0') {
      second = scan.number(2, 2);
      fraction = true;
    }
  }
  if (!hour || !minute || !second)
    return std::nullopt;
  const double seconds = *second + (fraction ? read_fraction(scan) : 0.0);
  const bool end_of_day = *hour == 24 && *minute == 0 && seconds == 0.0;
  WrittenTime time;
  if ((*hour > 23 && !end_of_day) || *minute > 59 || seconds > 60.0 || !read_zone(scan, time, *hour))
    return std::nullopt;
  time.seconds = kSecondsOfClockHour * *hour + kSecondsOfMinute * *minute + seconds;
  return time;
}

/// Completes a year of two digits: it is in this century.
int full_year(int year) {
  return year < 100 ? year + 2000 : year;
}

WrittenDate resolved_date(int year, int month, int day) {
  return {
      .first = full_year(year), .second = month, .third = day, .resolved = true, .points = false, .time = {}};
}

/// Reads "27-Oct-24", "2024-Oct-27" or "Oct 27, 2024". `first` is the number before the month, already read.
std::optional<WrittenDate> with_named_month(DateScanner& scan, std::optional<int> first) {
  constexpr int kMostDays = 31;
  const std::optional<int> month = month_of(scan.letters());
  scan.sign(".");
  while (scan.sign("-/ ,") != '\0') {
  }
  const std::optional<int> second = scan.number(1, 4);
  if (!month || !second)
    return std::nullopt;
  scan.sign(".");
  if (first)
    return *first > kMostDays ? resolved_date(*first, *month, *second)
                              : resolved_date(*second, *month, *first);
  while (scan.sign(" ,") != '\0') {
  }
  const std::optional<int> year = scan.number(4, 4);
  return year ? std::optional(resolved_date(*year, *month, *second)) : std::nullopt;
}

std::optional<WrittenDate> in_numbers(DateScanner& scan, int first) {
  const char separator = scan.sign("-./");
  const auto blanks_of_points = [&] { return separator == '.' && scan.blanks(); };  // as in 27. 10. 2024
  blanks_of_points();
  const std::optional<int> second = scan.number(1, 2);
  if (!second || scan.sign("-./") == '\0')
    return std::nullopt;
  blanks_of_points();
  const std::optional<int> third = scan.number(1, 4);
  if (!third)
    return std::nullopt;
  if (separator == '.' && scan.next() == '.')
    scan.sign(".");
  return WrittenDate{.first = first,
                     .second = *second,
                     .third = *third,
                     .resolved = false,
                     .points = separator == '.',
                     .time = {}};
}

/// Reads a date such as 20241027.
std::optional<WrittenDate> in_digits(std::string_view digits) {
  DateScanner of_year(digits.substr(0, 4)), of_month(digits.substr(4, 2)), of_day(digits.substr(6, 2));
  const auto year = of_year.number(4, 4), month = of_month.number(2, 2), day = of_day.number(2, 2);
  return year && month && day ? std::optional(resolved_date(*year, *month, *day)) : std::nullopt;
}

std::optional<WrittenDate> date_part(DateScanner& scan, bool& basic) {
  DateScanner look = scan;
  if (const std::string_view word = look.letters(); is_day_of_week(word) && !month_of(word)) {
    scan = look;
    while (scan.sign(" ,.") != '\0') {
    }
  }
  if (!scan.digit_next())
    return with_named_month(scan, std::nullopt);
  look = scan;
  if (const std::string_view digits = look.digits(8, 8); !digits.empty() && look.next() == 'T') {
    basic = true;
    scan = look;
    return in_digits(digits);
  }
  const std::optional<int> first = scan.number(1, 4);
  if (!first)
    return std::nullopt;
  look = scan;
  while (look.sign("-. /") != '\0') {
  }
  if (!look.digit_next() && !look.at_end()) {
    scan = look;
    return with_named_month(scan, first);
  }
  return in_numbers(scan, *first);
}

}  // namespace

std::optional<WrittenDate> written_date(std::string_view cell) {
  if (cell.size() > kLongestDate)
    return std::nullopt;
  DateScanner scan(cell);
  bool basic = false;
  std::optional<WrittenDate> date = date_part(scan, basic);
  if (!date || scan.at_end())
    return date;
  if (scan.sign("T,:") == '\0' && scan.next() != ' ')
    return std::nullopt;
  scan.blanks();
  date->time = read_time(scan, basic);
  return date->time ? date : std::nullopt;
}

std::optional<WrittenTime> written_time(std::string_view cell) {
  if (cell.size() > kLongestDate)
    return std::nullopt;
  DateScanner scan(cell);
  return read_time(scan, false);
}

std::optional<WrittenDate> compact_date(std::string_view cell) {
  constexpr std::size_t kMinutes = 12, kSeconds = 14, kMilliseconds = 17, kDate = 8;
  constexpr int kFirstYear = 1970, kLastYear = 2099;
  const bool fits = cell.size() == kMinutes || cell.size() == kSeconds || cell.size() == kMilliseconds;
  if (!fits || cell.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  std::optional<WrittenDate> date = in_digits(cell);
  std::string time(cell.substr(kDate, kSeconds - kDate));
  if (cell.size() == kMilliseconds)
    time += "." + std::string(cell.substr(kSeconds));
  DateScanner scan(time);
  if (date)
    date->time = read_time(scan, true);
  const bool real = date && date->time && date->first >= kFirstYear && date->first <= kLastYear &&
                    days_of(*date, DateOrder::year_month_day);
  return real ? date : std::nullopt;
}

std::optional<double> days_of(const WrittenDate& date, DateOrder order) {
  constexpr int kMostDays = 31;
  const bool year_first = date.resolved || order == DateOrder::year_month_day || date.first > kMostDays;
  const int year = year_first ? date.first : date.third;
  const int month = !year_first && order == DateOrder::month_day_year ? date.first : date.second;
  const int day = year_first ? date.third : order == DateOrder::month_day_year ? date.second : date.first;
  const std::chrono::year_month_day of_calendar{std::chrono::year(full_year(year)),
                                                std::chrono::month(static_cast<unsigned>(month)),
                                                std::chrono::day(static_cast<unsigned>(day))};
  if (!of_calendar.ok())
    return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(of_calendar).time_since_epoch().count());
}

}  // namespace mpm
