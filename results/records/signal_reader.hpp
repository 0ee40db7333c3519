#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "results/records/record_columns.hpp"
#include "results/records/sample_grid.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The signals in the columns of a file, in units of the study, a value a row.
class SignalReader {
 public:
  /// Both must outlive it; warnings go to the list. Qualities of what data.stored_on_change names are filled
  /// in `file`.
  SignalReader(const Study& study, RecordColumns& file, std::vector<std::string>& warnings);

  /// The column of a variable: that of its tag, "y.xD" as `mpmbench export` writes it (the prefix is "y"), or
  /// "xD". Errors: InputError with the nearest one.
  std::size_t column_of(const std::string& variable, const char* prefix) const;

  /// The numbers of a column as the study has them: scale (cell - operating point) of the variable. NaN where
  /// there is none, or one that cannot be measured (implausible_rows()). Errors: InputError for a column
  /// without a number.
  RowSignal numbers(std::size_t column, const std::string& variable);

  /// The same of a variable of the study, without values of bad quality: of the column that data.quality
  /// names, or of one that is found (quality_column_of()) and can be nothing else (are_qualities()). Errors:
  /// also InputError when no row of a column that is named is good.
  RowSignal variable(const std::string& name, const char* prefix);

  /// The signal of a variable with the value of the row before in each empty cell; a value that is bad or no
  /// number holds as well.
  RowSignal holding(const std::string& name, const char* prefix, RowSignal signal) const;

  /// Is it stored on change only?
  bool on_change(const std::string& variable) const;

  /// 1 where the controller is on, 0 where it is off, NaN where nothing is said.
  RowSignal controller_on() const;

  /// 1 where the controller has the variable (data.mode), 0 where operators have it, NaN where nothing is
  /// said.
  RowSignal in_use(const std::string& variable) const;

  /// Warns of setpoints and modes of variables that stand in the file and that [data] does not name.
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
