#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Whether the closed loop of a linear plant is stable under the controller, as long as its set of active
/// constraints is that of the operating point.
///
/// With this set the controller is linear. Its moves follow from the state of its model, from the inputs that
/// are still on their way, and from the output bias b = y - y_sim of the active CVs:
///
///     u(k) = L_x x(k) + L_u (u(k-1), ..., u(k-L)) + L_b b(k)
///
/// in deviations from rest, for the MVs that are not at a limit: the first move of the minimiser of the
/// objective (solvers/mpc_objective) without limits, its targets those that hold the active CVs where they
/// are, u_target = -K_active^-1 b. Together with the states of the channels of the plant that differ from the
/// model this is a linear map of one sample onto the next; its spectral radius is that of the loop.
///
/// A CV at a soft limit has two laws (docs/methods_thesis.md, T0): over its limit the slack pulls it back
/// with slack_weight at every sample of the horizon, inside only the targets draw it. A loop that rings goes
/// through both in turn; its radius is the larger one, that with all active CVs over their limits and that
/// with all of them inside.
///
/// | symbol | meaning                                                                   | shape        |
/// |--------|---------------------------------------------------------------------------|--------------|
/// | x      | states of the model's channels from the free MVs to the active CVs         | n            |
/// | L      | samples of which inputs are still on their way                            |              |
/// | b      | y - y_sim of the active CVs; 0 except for the channels that differ           | m            |
///
/// Channels with step coefficients are taken as the transfer functions that were fitted to these, in model
/// and plant: their own states would be as many as there are coefficients.
///
/// CVs inside their range act on nothing, so that their channels are not part of the loop.
class LoopStability {
 public:
  /// `point` is the operating point of the study, which must outlive the object. No law is known of a
  /// controller that is a program, of one slack for all samples of a CV (not linear), of a nonlinear plant,
  /// where the active CVs do not determine the targets, and where more than 1000 inputs are on their way.
  LoopStability(const Study& study, const OperatingPoint& point);

  /// Spectral radius of the loop with this plant, of the shape of the model: below 1 it is stable. NaN when
  /// no law is known.
  double spectral_radius(const TransferMatrix& plant) const;

  /// That of the loop of an experiment of this study, at the end of its onset. A change of its tuning must be
  /// in the study already (with_tuning()). NaN as well for a fault that makes the loop another one: of a
  /// valve, or an MV that is held.
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
  std::vector<Eigen::Index> cvs_, mvs_;  ///< active CVs, MVs that are free
  std::vector<Law> laws_;                ///< empty: none is known
};

}  // namespace mpm
