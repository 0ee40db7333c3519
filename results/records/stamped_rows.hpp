#pragma once

#include <string>
#include <vector>

#include "results/records/record_columns.hpp"
#include "results/records/time_stamps.hpp"
#include "scenarios/study/data_options.hpp"

namespace mpm {

/// Who asks for the rows of a file: what its stamps and columns are for.
struct RowsWanted {
  const DataOptions& data;
  double sample_time = 1.0;  ///< of the controller
  std::string time_unit;     ///< of the plant
  /// Names that columns may have, of which one at least is there unless the file is a long table.
  std::vector<std::string> names;
};

/// The rows of a file in the order of their stamps, however it holds them.
struct StampedRows {
  RecordColumns file;         ///< its rows from the earliest to the latest; warnings too
  std::vector<double> times;  ///< of the rows, in `unit`
  std::string unit;           ///< of the times: "s" of dates; empty: that of the plant
  bool stamped = true;        ///< otherwise each row is a sample
  bool calendar = false;      ///< times are s since 1970
  StampRules rules;           ///< by which a stamp of the study is read

  /// A time as people read it.
  std::string text(double time) const;
};

/// Reads the stamps of a file and brings its values into rows, one a time stamp:
///
/// 1. wide: as they stand. Dates and times of day may have a column each. A file with the newest row first is
///    turned round.
/// 2. time-per-tag: the values of each column at the stamps of the column of stamps before it.
/// 3. long: a column for each tag; of other columns of the table one for each tag too, "TAG.COLUMN".
///
/// What a tag has twice at one time gets a row of its own. Rows without a stamp are left out.
///
/// Errors: InputError that names the file, the line or column and the key: those of parse_time_stamps(),
/// stamps that go back, local times with a change of the clock, a layout that the file does not have.
StampedRows stamped_rows(const RowsWanted& wanted, RecordColumns file);

}  // namespace mpm
