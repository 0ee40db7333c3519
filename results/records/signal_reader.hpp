#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "results/records/record_columns.hpp"
#include "results/records/sample_grid.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Reads signals from the columns of a file, in units of the study, one value per row.
class SignalReader {
 public:
  /// `study` and `file` must outlive the reader; warnings go to the list. In `file` it fills the qualities of
  /// the variables in data.stored_on_change.
  SignalReader(const Study& study, RecordColumns& file, std::vector<std::string>& warnings);

  /// Returns the column of a variable: that of its tag, "y.xD" as `mpmbench export` writes it (the prefix is
  /// "y"), or "xD". Errors: InputError with the nearest name.
  std::size_t column_of(const std::string& variable, const char* prefix) const;

  /// Returns the numbers of a column in units of the study: scale (cell - operating point) of the variable.
  /// NaN if a cell has no number, or one that cannot be a measurement (implausible_rows()). Errors:
  /// InputError if the column has no number.
  RowSignal numbers(std::size_t column, const std::string& variable);

  /// Returns the same for a variable of the study, without values of bad quality. The quality is in the
  /// column that data.quality names, or in one that is found (quality_column_of()) and can only be a quality
  /// (are_qualities()). Errors: also InputError if no row of a named quality column is good.
  RowSignal variable(const std::string& name, const char* prefix);

  /// Returns the signal of a variable with each empty cell filled from the row before. A value that is bad or
  /// no number is held as well.
  RowSignal holding(const std::string& name, const char* prefix, RowSignal signal) const;

  /// Tells whether the variable is stored only on change.
  bool on_change(const std::string& variable) const;

  /// Returns 1 where the controller is on, 0 where it is off, NaN where the cell is empty.
  RowSignal controller_on() const;

  /// Returns 1 where the controller uses the variable (data.mode), 0 where operators do, NaN where the cell
  /// is empty.
  RowSignal in_use(const std::string& variable) const;

  /// Warns of columns with setpoints and modes of variables that [data] does not name.
  void tell_unnamed();

  bool has_numbers(std::size_t column) const;
  /// "FILE: data.KEY.VARIABLE"
  std::string where(const std::string& key, const std::string& variable) const;

 private:
  struct BadRows;

  RowSignal is_on(std::size_t column, const std::vector<std::string>& words) const;
  void fill(std::size_t column);
  std::pair<double, double> hard_limits(const std::string& variable) const;
  RowSignal numbers(std::size_t column, const std::string& variable, bool measured);
  void drop_implausible(std::size_t column, const std::string& variable, bool measured, RowSignal& signal);
  void drop_bad_quality(const std::string& variable, std::size_t column, RowSignal& signal);
  void look_at_quality(const std::string& variable, std::size_t quality, RowSignal& signal);
  BadRows bad_rows(std::size_t quality, const RowSignal& signal, bool named) const;
  bool is_named(std::size_t column) const;
  void tell_beside(const std::string& variable, const char* prefix, const char* ending, const char* key,
                   const char* why);
  bool is_word(const std::string& cell, const std::vector<std::string>& words) const;

  const Study& study_;
  const DataOptions& data_;
  RecordColumns& file_;
  std::vector<std::string>& warnings_;
};

}  // namespace mpm
