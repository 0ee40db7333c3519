#pragma once

#include <string>
#include <vector>

#include "results/records/record_columns.hpp"
#include "results/records/time_stamps.hpp"
#include "scenarios/study/data_options.hpp"

namespace mpm {

/// What a caller needs to say to get the rows of a file: how to read its stamps and columns.
struct RowsWanted {
  const DataOptions& data;
  double sample_time = 1.0;  ///< of the controller
  std::string time_unit;     ///< of the plant
  /// Names that columns may have. At least one of them occurs unless the file is a long table.
  std::vector<std::string> names;
};

/// The rows of a file in the order of their stamps, whatever its layout.
struct StampedRows {
  RecordColumns file;         ///< rows from the earliest to the latest, and warnings
  std::vector<double> times;  ///< times of the rows, in `unit`
  std::string unit;           ///< unit of the times: "s" for dates; empty: that of the plant
  bool stamped = true;        ///< if false, each row is a sample
  bool calendar = false;      ///< times are s since 1970
  StampRules rules;           ///< how to read a stamp in the study

  /// Returns a time as people read it.
  std::string text(double time) const;
};

/// Reads the stamps of a file and brings its values into rows, one row per time stamp:
///
/// 1. wide: the rows stay as they are. Dates and times of day may have separate columns. If the newest row
///    comes first, the rows are reversed.
/// 2. time-per-tag: each column has its values at the stamps of the nearest column of stamps before it.
/// 3. long: each tag becomes a column. Other columns of the table become one column per tag, "TAG.COLUMN".
///
/// If a tag has several values at one time, each gets a row of its own. Rows without a stamp are left out.
///
/// Errors: InputError that names the file, the line or column and the key: those of parse_time_stamps(),
/// stamps that go back, local times in which the clock changes, or a layout that the file does not have.
StampedRows stamped_rows(const RowsWanted& wanted, RecordColumns file);

}  // namespace mpm
