#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/study/data_options.hpp"

namespace mpm {

/// How to read the time stamps of a file.
struct StampRules {
  DateOrder order = DateOrder::automatic;
  char decimal = '.';
  std::string unit = {};      ///< unit of stamps that are numbers; empty: found, or else that of the plant
  std::string format = {};    ///< DataOptions::time_format
  std::string zone = {};      ///< DataOptions::time_zone
  std::string language = {};  ///< DataOptions::language
  double sample_days = 0.0;   ///< sample time in days, to recognise days of a spreadsheet; 0: not known
  double sample = 0.0;        ///< sample time in the time unit of the plant
};

/// Returns the rules that [data] gives for a plant; `sample_time` is in its time unit `time_unit`.
StampRules stamp_rules(const DataOptions& data, char decimal, double sample_time,
                       const std::string& time_unit);

/// The time stamps of a file of records.
struct TimeStamps {
  bool calendar = false;   ///< stamps are dates; otherwise numbers
  bool offsets = false;    ///< stamps are dates whose offset from UTC is known
  std::string unit = {};   ///< unit of `times`: "s" for dates; empty: that of the plant
  std::string found = {};  ///< unit of numbers that were recognised as dates without being told
  DateOrder order = DateOrder::automatic;  ///< order of the dates
  std::vector<double> times;               ///< seconds since 1970 for dates; NaN: no stamp
};

/// Where the stamps come from.
struct StampSource {
  std::string where;  ///< "records.csv: column 'time'"
  const std::vector<std::string>& cells;
  const std::vector<std::size_t>& lines;  ///< line of each cell in the file; 0: not from a file
};

/// Reads time stamps. They are dates in any form of written_date(), in any language (dates_in_english()),
/// dates of compact_date(), dates in the format of the rules, or numbers:
///
/// - If the rules name the unit of the numbers: numbers in s, ms, us and ns since 1970 that lie in the years
///   1990 to 2099 are dates, and so are days of a spreadsheet (since 1899-12-30) and of MATLAB (datenum).
/// - If the rules name no unit, such numbers are recognised as dates. Days must lie in the years 2000 to
///   2099, and their steps must fit the sample time as days but not as numbers in the unit of the plant.
///
/// Dates without an offset are taken as they are, or as the clock of the zone shows them. If a day and a
/// month could be exchanged, DateOrder decides, or a stamp with a number above 12. An empty cell is no stamp.
/// Errors: InputError if a cell is none of these or a time that no clock shows, if nothing decides the order,
/// for letters of an unknown zone, and if a column mixes two forms: numbers and dates, times with and without
/// an offset, or with and without AM or PM.
TimeStamps parse_time_stamps(const StampSource& source, const StampRules& rules);

/// Tells whether these cells are numbers that are recognised as dates.
bool are_dates_in_numbers(const std::vector<std::string>& cells, const StampRules& rules);

/// Formats a time in s since 1970: "2024-10-27 02:59:30".
std::string date_text(double seconds);

}  // namespace mpm
