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

// The simulated records beside a record: loops of the same controller, judged as it is.

namespace mpm {

/// Loops like a record of a plant, and how each of them is judged.
struct TrialRequest {
  Study study;  ///< trial_study(), one experiment a loop
  /// Makes what judges the loops by these of its methods, for each thread.
  std::function<LoopAssessor(const std::vector<std::string>& methods)> assessor;
};

/// The loops of a request with their answers. `keeps` holds what the records are read from.
struct TrialLoops {
  RecordRange records;
  std::string archive = {};  ///< where they are kept; empty: nowhere
  std::shared_ptr<const void> keeps = {};
};

/// Runs the loops of a request. Errors: InputError for a study that cannot be run.
using TrialRunner = std::function<TrialLoops(const TrialRequest&)>;

/// Runs them one after another and keeps them in memory.
TrialRunner trials_in_memory(QpSolverFactory factory);

/// How often simulated records of which the same source was said have it.
using CountsOfSource = std::function<TrialCounts(RecordSource)>;

/// Has the loops like the record run, and puts what they say into the assessment. What is returned asks the
/// first method for its sources; empty without such loops.
CountsOfSource add_trial(RecordAssessment& assessment, const Study& study,
                         const std::shared_ptr<const RecordFrame>& frame, int trials,
                         const TrialRunner& run_trials);

}  // namespace mpm
