#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/experiment.hpp"
#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// What a method says of one loop, as it is kept for all loops of a comparison.
struct MethodVerdict {
  AssessmentStatus status = AssessmentStatus::failed;
  bool flagged = false;                                     ///< Assessment::flagged
  double score = std::numeric_limits<double>::quiet_NaN();  ///< Assessment::score
  Eigen::Index located_cv = -1;                             ///< Assessment::worst_cv(), -1 for none
  ExperimentKind source = ExperimentKind::none;             ///< of the located CV
  std::vector<Channel> flagged_channels;                    ///< by CV and MV, each once
  double seconds = 0.0;  ///< of processor time; the only number that another run does not repeat
};

/// One loop, assessed by every method of the comparison.
struct ComparedLoop {
  std::int64_t experiment = 0;          ///< index in its campaign
  std::vector<MethodVerdict> verdicts;  ///< one a method
};

/// Methods of assessment on the same loops: all experiments of a campaign with status ok.
struct Comparison {
  std::vector<std::string> methods;  ///< names of assessment_methods()
  /// Why a method did not apply or gave no answer, that of the first such loop; empty when it always did.
  std::vector<std::string> reasons;
  std::vector<ComparedLoop> loops;  ///< in the order of the experiments
};

/// Assesses experiments of one study by several methods. One a thread; an answer depends on the experiment
/// only.
class MethodPanel {
 public:
  /// `study` and `basis` must outlive the panel; the basis case must have status ok and is the benchmark.
  /// Throws InputError for an unknown method.
  MethodPanel(const Study& study, const BasisCase& basis, const std::vector<std::string>& methods,
              QpSolverFactory factory);
  MethodPanel(const MethodPanel&) = delete;
  MethodPanel& operator=(const MethodPanel&) = delete;

  /// What each method says of the experiment, whose status is ok: of its stored loop, or of the loop run
  /// again. Where the experiment changes the tuning the methods know the S0 of the controller that runs, as
  /// own_basis() has it. Every method failed where the loop, run again, does not reach its end, or where its
  /// controller has no S0. `reasons[m]` is why method m gave no answer, empty when it did.
  ComparedLoop assess(const ExperimentRecord& record, std::vector<std::string>& reasons);

 private:
  std::vector<Assessor> assessors_for(const AssessmentContext& context) const;

  const Study& study_;
  const BasisCase& basis_;
  QpSolverFactory factory_;
  AssessmentContext context_;
  std::vector<AssessmentMethodInfo> methods_;
  std::vector<Assessor> assessors_;  ///< of loops under the controller of the study
};

}  // namespace mpm
