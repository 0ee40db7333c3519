#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenarios/study/data_options.hpp"

namespace mpm {

/// A time of day as it is written.
struct WrittenTime {
  double seconds = 0.0;          ///< since midnight; a time of 24:00 belongs to the next day
  std::optional<double> offset;  ///< from UTC, s
  std::string zone;              ///< letters in place of an offset, such as CET
  bool twelve_hours = false;     ///< written with AM or PM
};

/// A date as it is written, and its time of day.
struct WrittenDate {
  int first = 0, second = 0, third = 0;  ///< in the written order; year, month, day if `resolved`
  bool resolved = false;                 ///< a month name or the form shows which number is which
  bool points = false;                   ///< points separate the numbers
  std::optional<WrittenTime> time;
};

/// Reads the date in a cell, with or without a time of day:
///
///   2024-10-27 02:59:30.5   2024-10-27T02:59:30Z      20241027T025930+01:00   27.10.2024 02:59
///   10/27/2024 2:59:30 PM   27-Oct-24 02:59:30 CET    Sun 27 Oct 2024 02:59   Oct 27, 2024 2:59 AM
///
/// Blanks may follow points between the numbers. Names of months and days may be English or German, in full
/// or with their first three letters; dates_in_english() handles other languages. Returns none for any other
/// form, and for a time that no clock shows.
std::optional<WrittenDate> written_date(std::string_view cell);

/// Reads the time of day in a cell without a date: 02:59, 2:59:30.5 PM, 02:59:30+01:00. Returns none for any
/// other form.
std::optional<WrittenTime> written_time(std::string_view cell);

/// Reads a date of 12, 14 or 17 digits without signs between them: 20241027025930. Returns none for other
/// numbers.
std::optional<WrittenDate> compact_date(std::string_view cell);

/// Returns days since 1970; none if the day does not exist. `order` applies to a date that is not resolved.
std::optional<double> days_of(const WrittenDate& date, DateOrder order);

}  // namespace mpm
