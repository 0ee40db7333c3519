#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/study_findings.hpp"
#include "base/row.hpp"

// The one description of an experiment's record: each number of it is a row. The archive, the bytes of a
// shard, the comparison of `replay` and the CSV tables iterate over them; a new number is one row more.

namespace mpm {

using RecordRow = Row<ExperimentRecord>;

/// Rows of a group of the archive, along a dimension of all or some of the experiments.
struct RecordTable {
  std::string group;       ///< "methods/botelho"; empty: the root group
  std::string dimension;   ///< "experiment", "stored", "perturbed"
  std::string title;       ///< of the group; empty for the root group
  bool from_draw = false;  ///< they follow from study and index, by which bytes draw the experiment anew
  /// Which experiments stand in it, and how room is made in a record; empty: all of them.
  std::function<bool(const ExperimentRecord&)> has = {};
  std::function<void(ExperimentRecord&)> make = {};
  std::vector<RecordRow> rows = {};

  bool covers(const ExperimentRecord& record) const { return !has || has(record); }
};

/// All tables of the records of a study, in an order in which they can be put back.
std::vector<RecordTable> record_tables(const Study& study, const AssessmentForms& forms);

/// The description of a number of a method in files, as `text`, with its value for loops without a verdict.
NumberText kept_text(NumberText text);

}  // namespace mpm
