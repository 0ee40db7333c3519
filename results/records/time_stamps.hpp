#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/study/data_options.hpp"

namespace mpm {

/// How the time stamps of a file are to be read.
struct StampRules {
  DateOrder order = DateOrder::automatic;
  char decimal = '.';
  std::string unit = {};      ///< of numbers; empty: found, else that of the plant
  std::string format = {};    ///< DataOptions::time_format
  std::string zone = {};      ///< DataOptions::time_zone
  std::string language = {};  ///< DataOptions::language
  double sample_days = 0.0;   ///< sample time, by which days of a spreadsheet are known; 0: they are not
  double sample = 0.0;        ///< the same in the time unit of the plant
};

/// The rules that [data] gives, for a plant whose sample time is `sample_time` of its time unit.
StampRules stamp_rules(const DataOptions& data, char decimal, double sample_time,
                       const std::string& time_unit);

/// The time stamps of a file of records.
struct TimeStamps {
  bool calendar = false;   ///< dates; otherwise numbers
  bool offsets = false;    ///< dates whose offset from UTC is known
  std::string unit = {};   ///< of `times`: "s" of dates; empty: that of the plant
  std::string found = {};  ///< the unit by which numbers were taken for dates, without being told
  DateOrder order = DateOrder::automatic;  ///< of dates
  std::vector<double> times;               ///< since 1970 of dates; NaN: no stamp
};

/// Where the stamps come from.
struct StampSource {
  std::string where;  ///< "records.csv: column 'time'"
  const std::vector<std::string>& cells;
  const std::vector<std::size_t>& lines;  ///< of the cells
};

/// Dates in any form of written_date(), in any language (dates_in_english()), or of compact_date(), or as the
/// rules say, or numbers:
///
/// - of a unit that the rules name. Those of s, ms, us and ns in the years 1990 to 2099 since 1970 are dates,
///   and so are days of a spreadsheet (since 1899-12-30) and of MATLAB (datenum);
/// - without one, such numbers are known as dates; days of the years 2000 to 2099 only where
///   their steps fit the sample time as days, and not as numbers of the unit of the plant.
///
/// Dates without an offset are taken as they stand, or as the clock of the zone shows them. Of a day and a
/// month that could be either way round DateOrder decides, or a stamp with a number above 12. An empty cell
/// is no stamp. Errors: InputError for a cell that is none of this or no time that a clock shows, for an
/// order that nothing decides, letters of an unknown zone, and for a column of two forms: numbers and dates,
/// times with and without an offset, with and without AM or PM.
TimeStamps parse_time_stamps(const StampSource& source, const StampRules& rules);

/// Are these cells numbers that are known as dates?
bool are_dates_in_numbers(const std::vector<std::string>& cells, const StampRules& rules);

/// "2024-10-27 02:59:30" of a time in s since 1970.
std::string date_text(double seconds);

}  // namespace mpm
