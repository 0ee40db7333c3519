#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/study/record_options.hpp"

namespace mpm {

/// The order of day, month and year in the time stamps of a file.
enum class DateOrder { automatic, year_month_day, day_month_year, month_day_year };

/// How the rows of a file hold the values.
enum class TableLayout {
  automatic,     ///< found in the heading
  wide,          ///< a row a time stamp, a column a variable
  time_per_tag,  ///< each column of values has its own time stamps, in the column of stamps before it
  long_table,    ///< a row a value: time stamp, tag, value
};

/// Which value a CV has at a sample if the file has several values for it.
enum class CvResampling { mean, nearest };

/// Where the record begins: at rest at the operating point, or anywhere. If it begins anywhere, the model is
/// taken to be at rest at the first values, and CVs are not judged before the slowest channel has settled.
enum class RecordStart { automatic, rest, anywhere };

/// How the columns of a file of records map to the study: [data] of a study file. Names and numbers by
/// variable are empty if the study gives none. A value in the study is scale (recorded - operating_point).
struct DataOptions {
  using Names = std::map<std::string, std::string>;
  using Numbers = std::map<std::string, double>;

  std::string time;         ///< column; empty: one with a usual name, or none
  std::string date;         ///< column of the dates where `time` has times of day only; empty: found
  std::string time_unit;    ///< of stamps that are numbers; empty: found, else that of the plant
  std::string time_format;  ///< of dates, as strptime() has it; empty: found
  std::string time_zone;    ///< IANA name of the zone whose clock the stamps show; empty: no offset
  std::string language;     ///< of the words in dates, as CLDR names it; empty: found
  DateOrder date_order = DateOrder::automatic;
  std::vector<int> skip;  ///< lines of the file that are not read, from 1
  TableLayout layout = TableLayout::automatic;
  std::string tag_column, value_column;  ///< of a long table; empty: those with usual names
  std::string separator;                 ///< one character; empty: found
  std::string decimal;                   ///< "." or ","; empty: found
  Names tags;               ///< columns of CVs, MVs and MDs; without one: the column with the variable's name
  Numbers operating_point;  ///< in the unit of the file; without one: 0
  Numbers scale;            ///< unit of the study over that of the file; without one: 1
  Names setpoint;           ///< columns of the setpoints of CVs, recorded as the CV is
  Names lower, upper;       ///< columns of the soft limits of CVs, recorded as the CV is
  Names y_sim;              ///< columns of the model's output, recorded as the CV is; without one: computed
  Names target;             ///< columns of the targets of MVs, recorded as the MV is
  Names quality;            ///< columns of the quality of any variable
  Names mode;               ///< columns of the mode of CVs and MVs: does the controller have it?
  std::vector<std::string> mode_on{"1", "on", "true", "auto", "cas", "rcas", "rout"};
  std::vector<std::string> good_quality{"good", "opc"};
  std::vector<std::string> stored_on_change;  ///< variables whose last value holds until the next one
  std::string controller_on;                  ///< column; empty: the controller is always on
  std::vector<std::string> on_values{"1", "on", "true", "auto"};
  CvResampling cv_resampling = CvResampling::mean;
  RecordStart start = RecordStart::automatic;
  double most_missing = 0.3;            ///< share of the samples of a CV; beyond it the record is refused
  std::vector<std::string> candidates;  ///< columns of signals that the model does not know
  GapFill fill = GapFill::none;         ///< what the methods see where a CV is missing
  std::vector<std::string> period;      ///< two time stamps; empty: the whole file
  std::vector<std::string> benchmark;   ///< two time stamps, "found" or "none"; empty: none is named

  bool operator==(const DataOptions&) const = default;
};

}  // namespace mpm
