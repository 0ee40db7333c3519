#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/records/assessed_record.hpp"
#include "analysis/records/record_trials.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/for_each_with_solver.hpp"
#include "solvers/qp_solver.hpp"

// A record of a plant under the study of its controller: what the methods say of it, and how far to trust
// them.

namespace mpm {

/// How a record is assessed.
struct AssessOptions {
  std::vector<std::string> methods{"mpmbench"};  ///< shown beside the verdict, which is that of `mpmbench`
  /// Standard deviation of the errors that a healthy model may have in gain, time constants and dead time of
  /// every channel; 0: the model is exact.
  double model_error = 0.05;
  int trials = 200;  ///< simulated records like this one; 0: none
  std::optional<MonitoringOptions> monitoring = {};
  ForEachWithSolver for_each = {};  ///< runs the loops that estimate what repairs bring; empty: one by one
};

/// Assesses a record that was read under `study`. The result has the nominal loop under what moved the plant,
/// the answers of the methods, the checks of model and controller, the simulated records beside it, what a
/// repair of the named channel would bring, and the verdict. `run_trials` runs the simulated records; if
/// there are none, RecordAssessment::no_trial says why. Throws InputError for a record that the study cannot
/// explain: units, limits, a controller without a model, too few samples. Errors of `run_trials` other than
/// InputError are passed on.
RecordAssessment assess_record(const Study& study, PlantRecord record, const AssessOptions& options,
                               const QpSolverFactory& factory, const TrialRunner& run_trials);

}  // namespace mpm
