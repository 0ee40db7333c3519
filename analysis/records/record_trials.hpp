#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "analysis/records/assessed_record.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_verdict.hpp"
#include "analysis/records/trial_record.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

// The simulated records beside a record: loops of the same controller, judged in the same way.

namespace mpm {

/// Loops like a record of a plant, and how each of them is judged.
struct TrialRequest {
  Study study;  ///< trial_study(), one experiment a loop
  /// Makes the assessor that judges the loops by these methods of the study, one for each thread.
  std::function<LoopAssessor(const std::vector<std::string>& methods)> assessor;
};

/// The loops of a request with their answers. `keeps` keeps alive what the records are read from.
struct TrialLoops {
  RecordRange records;
  std::string archive = {};  ///< where they are kept; empty: nowhere
  std::shared_ptr<const void> keeps = {};
};

/// Runs the loops of a request. Errors: InputError for a study that cannot be run.
using TrialRunner = std::function<TrialLoops(const TrialRequest&)>;

/// Returns a runner that runs the loops one after another and keeps them in memory.
TrialRunner trials_in_memory(QpSolverFactory factory);

/// Counts how often simulated records really have this source if the answer on them names it.
using CountsOfSource = std::function<TrialCounts(RecordSource)>;

/// Runs loops like the record and puts their findings into the assessment. The returned function asks the
/// first method for its sources; it is empty if there are no such loops.
CountsOfSource add_trial(RecordAssessment& assessment, const Study& study,
                         const std::shared_ptr<const RecordFrame>& frame, int trials,
                         const TrialRunner& run_trials);

}  // namespace mpm
