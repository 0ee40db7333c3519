#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/study_findings.hpp"
#include "base/row.hpp"

// The only description of an experiment's record: each number of it is a row. The archive, the bytes of a
// shard, the comparison of `replay` and the CSV tables iterate over these rows; a new number is one more row.

namespace mpm {

using RecordRow = Row<ExperimentRecord>;

/// Rows of a group of the archive, along a dimension of all or some of the experiments.
struct RecordTable {
  std::string group;       ///< "methods/botelho"; empty: the root group
  std::string dimension;   ///< "experiment", "stored", "perturbed"
  std::string title;       ///< of the group; empty for the root group
  bool from_draw = false;  ///< the rows follow from study and index; bytes leave them out
  /// `has` tells which experiments are in the table (empty: all); `make` makes room for the rows in a record.
  std::function<bool(const ExperimentRecord&)> has = {};
  std::function<void(ExperimentRecord&)> make = {};
  std::vector<RecordRow> rows = {};

  bool covers(const ExperimentRecord& record) const { return !has || has(record); }
};

/// All tables of the records of a study, in an order in which their values can be read back into a record.
std::vector<RecordTable> record_tables(const Study& study, const AssessmentForms& forms);

/// Returns the description of a number of a method as files state it: `text` with the value that stands for a
/// missing verdict.
NumberText kept_text(NumberText text);

}  // namespace mpm
