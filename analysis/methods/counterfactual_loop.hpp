#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "scenarios/loop/closed_loop.hpp"

namespace mpm {

/// Who can simulate the controller to find S0 can simulate the nominal loop itself. With G0 the model and
/// e = y - y_sim the simulation errors of the record,
///
///   y0      = output of the controller on G0, under the recorded measured disturbances, without noise
///   y0_diag = the same for CV i when the recorded errors e_j of all other CVs are added to the outputs of G0
///   Ivar = var y / (var y0 + v),   Ivar_diag = var y_i / (var y0_diag,i + v_i),   v = var y_b - var y0_b
///
/// as (3.24) and (4.14) have them, but exact where limits are left and reached again, where no linear S0 is:
/// with the errors of all CVs added the loop gives y back. y holds noise and y0 none; v, what noise adds to
/// the variance, is that of the basis case y_b of the same controller, so that only the variance of the
/// benchmark is known of it (NoiseVariance has other choices). Gaps of e are closed along straight lines. Of
/// a window the record is simulated from its start, once for all windows.
class CounterfactualLoop {
 public:
  /// `context` must outlive it.
  explicit CounterfactualLoop(const AssessmentContext& context);

  /// Flagged when some Ivar lies outside the band of impact, with the number `ivar` of each CV and no verdict
  /// on single CVs; failed when the controller does not run on its own model. Costs a closed loop, or none
  /// when the disturbances are those of the record before.
  Assessment impact(const AssessedLoop& loop);

  /// Ivar_diag of each CV, ny; NaN when its loop does not run to its end. Costs a closed loop a CV.
  Eigen::VectorXd ivar_diag(const AssessedLoop& loop);

  /// What Ivar_diag says of each CV of a flagged loop; nothing of one where it is NaN. Where all are, no loop
  /// runs to its end under the errors of the others: then Ivar of `impact` says it.
  std::vector<CvAssessment> located(const Eigen::VectorXd& ivar_diag, const Assessment& impact) const;

 private:
  /// A loop that was simulated, with what it was simulated under.
  struct Simulated {
    Eigen::MatrixXd d, errors;
    Trajectory loop;
  };

  const Trajectory& simulated(std::size_t place, const Eigen::MatrixXd& d, const Eigen::MatrixXd& errors);
  Eigen::VectorXd noise_variance(const Eigen::VectorXd& noisy, const Eigen::VectorXd& quiet) const;
  Eigen::VectorXd indices(const AssessedLoop& loop, const Trajectory& nominal) const;
  double distance(double ivar) const;

  const Study& study_;
  QpSolverFactory factory_;
  Eigen::MatrixXd y_set_, dither_;
  std::vector<Simulated> loops_;  ///< y0, then y0_diag of each CV
  Eigen::VectorXd noise_;         ///< v of each CV; empty when the basis case cannot be simulated
};

}  // namespace mpm
