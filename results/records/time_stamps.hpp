#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/study/data_options.hpp"

namespace mpm {

/// The time stamps of a file of records.
struct TimeStamps {
  bool calendar = false;      ///< dates; otherwise numbers
  bool offsets = false;       ///< dates of which each has its offset from UTC
  std::vector<double> times;  ///< in s since 1970 of dates, as they stand of numbers; NaN: no stamp
};

/// Where the stamps come from.
struct StampSource {
  std::string where;  ///< "records.csv: column 'time'"
  const std::vector<std::string>& cells;
  const std::vector<std::size_t>& lines;  ///< of the cells
};

/// Numbers, or dates with or without a time of day:
///
///   2024-10-27 02:59:30.5   2024-10-27T02:59:30Z   2024-10-27T02:59:30+01:00
///   27.10.2024 02:59        10/27/2024 2:59:30 PM
///
/// Without an offset they are taken as they stand. Of a day and a month that could be either way round
/// DateOrder decides, or a stamp with a number above 12. An empty cell is no stamp. Errors: InputError for a
/// cell that is none of this or no time that a clock shows, for an order that nothing decides, and for a
/// column of two forms: numbers and dates, times with and without an offset, with and without AM or PM.
TimeStamps parse_time_stamps(const StampSource& source, DateOrder order, char decimal);

/// Is it a date of one of these forms?
bool is_date(const std::string& cell);

/// "2024-10-27 02:59:30" of a time in s since 1970.
std::string date_text(double seconds);

}  // namespace mpm
