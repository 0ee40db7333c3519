#pragma once

#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "plants/analyser.hpp"

namespace mpm {

/// Whether a weight Q of the thesis multiplies x or its square: |Q x|^2 can be read either way
/// (docs/methods.md).
enum class WeightConvention {
  direct,   ///< Q x^2: the number in the table is the weight
  squared,  ///< (Q x)^2: (6.20) read to the letter
};

/// What one slack variable of (6.20) relaxes.
enum class SlackForm {
  per_sample,  ///< the soft limits of one CV at one predicted sample
  per_cv,      ///< the soft limits of one CV over the whole horizon; its weight counts once a sample
};

std::string_view to_string(WeightConvention convention);
std::string_view to_string(SlackForm form);

/// Lower and upper limits of a group of variables; an absent limit is infinite.
struct Limits {
  Eigen::VectorXd lower, upper;

  static Limits none(Eigen::Index size);
  /// Throws InputError that names `what` when the size is not `size`, a limit is NaN or limits cross.
  void validate(std::string_view what, Eigen::Index size) const;

  friend bool operator==(const Limits& a, const Limits& b);
};

/// Tuning of a model predictive controller: which terms its objective has and which limits it keeps.
///
/// Every CV may have a setpoint (setpoint_weight > 0), a soft range and hard limits, in any combination;
/// every MV may have a target (target_weight > 0). The controllers of the thesis are special cases:
///
/// | controller                        | setpoint_weight | cv_soft | target_weight |
/// |-----------------------------------|-----------------|---------|---------------|
/// | range MPC (2.33, 6.20)            | 0               | finite  | > 0           |
/// | setpoint MPC (2.26, 3.8, 3.30)    | > 0             | none    | 0             |
/// | soft-constraint MPC (3.33)        | 0               | finite  | 0             |
///
/// If an MV has a target, a target optimizer (6.19) stands above the controller. It holds CVs that have a
/// setpoint at it, and the others within their soft ranges.
///
/// | symbol   | member             | shape | unit                        |
/// |----------|--------------------|-------|-----------------------------|
/// | Ts       | sample_time        |       | time unit of the plant      |
/// | ph       | prediction_horizon |       | samples                     |
/// | mh       | control_horizon    |       | samples                     |
/// | Q_du     | move_suppression   | nu    | 1 / MV^2                    |
/// | Q_u      | target_weight      | nu    | 1 / MV^2                    |
/// | Q_y      | setpoint_weight    | ny    | 1 / CV^2                    |
/// | tau_y    | slack_weight       | ny    | 1 / CV^2                    |
/// | l_y      | slack_cost         | ny    | 1 / CV                      |
/// | phi_u    | mv_cost            | nu    | 1 / MV                      |
/// | r_u, w_u | resting_value, resting_weight | nu | MV, 1 / MV^2        |
/// | du_max   | move_limit         | nu    | MV a sample                 |
/// | tau_ref  | reference_time     | ny    | time unit of the plant      |
/// | alpha    | bias_ramp          | ny    | 1                           |
/// |          | analysers          | ny    | samples                     |
/// |          | md_analysers       | nd    | samples                     |
struct MpcOptions {
  double sample_time = 1.0;
  int prediction_horizon = 1;
  int control_horizon = 1;
  Eigen::VectorXd move_suppression;
  Eigen::VectorXd target_weight;
  Eigen::VectorXd setpoint_weight;  ///< 0: the CV has no setpoint
  Eigen::VectorXd slack_weight;     ///< its sum with slack_cost is above 0 for a CV with a soft limit
  Eigen::VectorXd slack_cost = {};  ///< linear cost of a slack; empty or 0: none
  /// Time constant with which the CV should approach its setpoint from where it is; empty or 0: at once.
  Eigen::VectorXd reference_time = {};
  /// For CVs that integrate, 0 to 1: the share of the change of the output bias from one sample to the next
  /// that counts as its ramp, which the prediction continues (Mpc). Empty or 0: the bias is a constant.
  Eigen::VectorXd bias_ramp = {};
  /// For CVs that an analyser measures: the output-bias feedback compares an analysis with the model at the
  /// sample at which it was taken. Empty: none.
  std::vector<AnalyserTiming> analysers = {};
  /// For MDs that are measured late: a new value was measured `delay` samples before, and the model is
  /// corrected from there on (LateMeasurements). Empty: none.
  std::vector<AnalyserTiming> md_analysers = {};
  /// Samples for which each planned position of the MVs is held (move blocking). The last position is held to
  /// the end of the horizon and has no entry. Empty: one sample each.
  std::vector<int> move_blocks = {};
  WeightConvention weight_convention = WeightConvention::direct;
  SlackForm slack_form = SlackForm::per_sample;
  Limits mv_hard;
  Eigen::VectorXd move_limit = {};  ///< largest |u(k) - u(k-1)|; empty or infinite: none
  Limits cv_hard;
  Limits cv_soft;
  Eigen::VectorXd mv_cost;
  /// Resting values of the MVs, held as far as the limits of the CVs allow: w_u (u_tgt - r_u)^2 in the
  /// objective (6.19). Empty or weights of 0: no resting values.
  Eigen::VectorXd resting_value = {}, resting_weight = {};
  /// Cost of a unit of steady-state violation of a CV soft limit in the target optimizer, relative to the
  /// largest slope of its objective, |mv_cost| without resting values. It is so large that limits are left
  /// only if no target keeps them (docs/methods.md).
  double target_violation_cost = 1000.0;
  /// Processor seconds that Ipopt may take for one problem (QpSolver::set_time_limit()).
  double solver_time_limit = 10.0;

  bool has_setpoint(Eigen::Index cv) const { return setpoint_weight(cv) > 0.0; }
  bool has_setpoints() const { return (setpoint_weight.array() > 0.0).any(); }
  /// Whether a target optimizer chooses the targets of the MVs.
  bool has_targets() const { return (target_weight.array() > 0.0).any(); }
  bool has_soft_limit(Eigen::Index cv) const;
  bool has_soft_limits() const;
  bool has_move_limits() const;
  bool has_reference(Eigen::Index cv) const;
  bool has_slack_cost(Eigen::Index cv) const;
  bool has_bias_ramps() const;
  bool has_resting_values() const;
  /// Sample of the horizon from which planned position i acts, i = 0 ... control_horizon - 1.
  std::vector<int> move_starts() const;

  /// Throws InputError for sizes, signs or horizons that make no controller.
  void validate(Eigen::Index cv_count, Eigen::Index mv_count, Eigen::Index md_count) const;

  friend bool operator==(const MpcOptions& a, const MpcOptions& b);
};

}  // namespace mpm
