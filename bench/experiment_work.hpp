#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "scenarios/audit.hpp"

namespace mpm {

/// How the problems of a campaign are solved.
struct SolverPlan {
  std::string solver = "auto";  ///< a name that qp_solver_factory knows
  double audit_share = 0.0;     ///< share of the steps whose problems Ipopt solves once more
};

/// What came of one experiment.
struct ExperimentOutcome {
  ExperimentRecord record;
  std::vector<AuditSample> samples;  ///< steps that are still to be audited
  std::vector<AuditedStep> audited;
  double audit_seconds = 0.0;  ///< processor time
};

/// The work of a campaign, as one worker does it: runs experiments and audits steps. Belongs to one thread or
/// process.
class ExperimentWork {
 public:
  /// `study` and `basis` must outlive it.
  ExperimentWork(const Study& study, const BasisCase& basis, const SolverPlan& plan, StorePolicy store);

  /// Experiment `index` without its audits. An exception makes a record `failed` with its text.
  ExperimentOutcome run(std::int64_t index);

  /// Audits the samples of an outcome. Calls Ipopt.
  void audit(ExperimentOutcome& outcome);

 private:
  const Study& study_;
  SolverPlan plan_;
  StorePolicy store_;
  ExperimentRunner runner_;
  std::optional<Auditor> auditor_;  ///< made when first needed
};

/// The record of an experiment that was lost, with the reason.
ExperimentRecord lost_record(const Study& study, std::int64_t index, std::string why);

}  // namespace mpm
