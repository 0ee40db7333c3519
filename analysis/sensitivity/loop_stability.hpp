#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Determines whether the closed loop of a linear plant and the controller is stable, as long as the active
/// constraints are those of the operating point.
///
/// With these constraints the controller is linear. Its moves follow from the state of its model, from the
/// past inputs that are still in the dead times, and from the output bias b = y - y_sim of the active CVs:
///
///     u(k) = L_x x(k) + L_u (u(k-1), ..., u(k-L)) + L_b b(k)
///
/// in deviations from rest, for the MVs that are not at a limit. This is the first move of the minimiser of
/// the objective (solvers/mpc_objective) without limits. Its targets hold the active CVs where they are,
/// u_target = -K_active^-1 b. Together with the states of the channels of the plant that differ from the
/// model, it is a linear map from one sample to the next; its spectral radius is that of the loop.
///
/// A CV at a soft limit has two laws (docs/methods_thesis.md, T0). Beyond its limit, the slack pulls it back
/// with slack_weight at every sample of the horizon; inside, only the targets act on it. A loop that rings
/// goes through both in turn. Its radius is the larger of two: that with all active CVs beyond their limits
/// and that with all of them inside.
///
/// | symbol | meaning                                                                   | shape        |
/// |--------|---------------------------------------------------------------------------|--------------|
/// | x      | states of the model's channels from the free MVs to the active CVs         | n            |
/// | L      | number of past samples whose inputs are still in the dead times           |              |
/// | b      | y - y_sim of the active CVs; 0 except for the channels that differ           | m            |
///
/// In model and plant, channels with step coefficients are replaced by the transfer functions that were
/// fitted to them: otherwise they would have as many states as coefficients.
///
/// CVs inside their range have no effect, so that their channels are not part of the loop.
class LoopStability {
 public:
  /// `point` is the operating point of `study`, and `study` must outlive the object. No law is known for a
  /// controller that is a program, for one slack for all samples of a CV (not linear), for a nonlinear or
  /// integrating plant, for reference trajectories, slack costs, resting values or analysers, if no MV is
  /// free, if the active CVs do not determine the targets, or if more than 1000 past inputs are needed.
  LoopStability(const Study& study, const OperatingPoint& point);

  /// Returns the spectral radius of the loop with this plant, which has the shape of the model. The loop is
  /// stable if the radius is below 1. NaN if no law is known.
  double spectral_radius(const TransferMatrix& plant) const;

  /// Returns the spectral radius of the loop of an experiment of this study, at the end of its onset. A
  /// change of its tuning must already be in the study (with_tuning()). Also NaN for a fault that changes the
  /// loop (a valve, or an MV that is held) and for changed parameters of a nonlinear plant.
  double spectral_radius(const ExperimentDraw& draw) const;

 private:
  /// L_x and L_u side by side, and L_b.
  struct Law {
    Eigen::MatrixXd of_state, of_bias;
  };

  double radius_with(const Law& law, const TransferMatrix& plant) const;

  const Study& study_;
  TransferMatrix model_;
  double sample_time_;
  std::vector<Eigen::Index> cvs_, mvs_;  ///< active CVs, free MVs
  std::vector<Law> laws_;                ///< empty if no law is known
};

}  // namespace mpm
