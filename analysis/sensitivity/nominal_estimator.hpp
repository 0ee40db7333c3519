#pragma once

#include <map>

#include "analysis/sensitivity/control_structure.hpp"
#include "analysis/sensitivity/nominal_output.hpp"

namespace mpm {

/// Estimates the nominal outputs of the loops of one study, with the S0 that `study.sensitivity.structure`
/// selects:
///
/// - operating_point: the S0 of the basis case throughout (assumptions A and B of 3.3.3, B by fixed_mvs);
/// - by_instant: the S0 of the constraints that are active at each sample (assumption C). With p(k) the
///   structure at sample k and T0_p its sensitivity, there are two readings of "the compatible T0":
///
///     switched output:  y0(k) = y_sim(k) + sum_l h_p(k)(l) (y - y_sim)(k - l)
///     switched input:   y0(k) = y_sim(k) + sum_l h_p(k-l)(l) (y - y_sim)(k - l)
///
///   with h_p the impulse response of T0_p. The first treats the whole past as if the present structure had
///   always been active; in the second an error continues to act with the structure of its own time.
///
/// It keeps the sensitivities that it has determined, so each thread needs its own.
class NominalEstimator {
 public:
  /// `study`, `point` and `sensitivity` (those of the basis case) must outlive the estimator.
  NominalEstimator(const Study& study, const OperatingPoint& point, const NominalSensitivity& sensitivity,
                   QpSolverFactory factory);

  /// Returns y_sim of a loop, also after its last sample, where the inputs are zero. For a CV with an
  /// analyser it is what the analyser would show of y_sim, because T0 describes what analysers show.
  Eigen::MatrixXd simulated(const Trajectory& loop) const;

  /// Returns y_sim, y0 and y0_diag of a loop that ran to its end. Throws InputError as nominal_sensitivity().
  NominalOutputs estimate(const Trajectory& loop);
  /// Returns the same if y_sim, the result of simulated(), is already known.
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
