#pragma once

#include <map>

#include "analysis/sensitivity/control_structure.hpp"
#include "analysis/sensitivity/nominal_output.hpp"

namespace mpm {

/// Estimates the nominal outputs of the loops of one study, by the S0 that the study asks for
/// (study.sensitivity.structure):
///
/// - operating_point: the S0 of the basis case throughout (assumptions A and B of 3.3.3, B by fixed_mvs);
/// - by_instant: the S0 of the constraints that are active at each sample (assumption C). With p(k) the
///   structure at sample k and T0_p its sensitivity there are two readings of "the compatible T0",
///
///     switched output:  y0(k) = y_sim(k) + sum_l h_p(k)(l) (y - y_sim)(k - l)
///     switched input:   y0(k) = y_sim(k) + sum_l h_p(k-l)(l) (y - y_sim)(k - l)
///
///   with h the impulse response of T0. The first takes the whole past as if the structure had always been
///   that of today; in the second an error goes on to act as it did when it occurred.
///
/// Keeps the sensitivities that it has determined; each thread needs its own.
class NominalEstimator {
 public:
  /// `study`, `point` and `sensitivity` (those of the basis case) must outlive the estimator.
  NominalEstimator(const Study& study, const OperatingPoint& point, const NominalSensitivity& sensitivity,
                   QpSolverFactory factory);

  /// y_sim of a loop, zero inputs after its last sample included. Of a CV of an analyser, what this would
  /// show of it, as T0 is that of what analysers show.
  Eigen::MatrixXd simulated(const Trajectory& loop) const;

  /// y_sim, y0 and y0_diag of a loop that ran to its end. Throws InputError as nominal_sensitivity().
  NominalOutputs estimate(const Trajectory& loop);
  /// The same where y_sim, that of simulated(), is known.
  NominalOutputs estimate(const Trajectory& loop, const Eigen::MatrixXd& y_sim);

 private:
  const NominalSensitivity& sensitivity_of(const ControlStructure& structure);

  const Study& study_;
  const OperatingPoint& point_;
  const NominalSensitivity& sensitivity_;
  QpSolverFactory factory_;
  std::map<ControlStructure, NominalSensitivity> by_structure_;
};

}  // namespace mpm
