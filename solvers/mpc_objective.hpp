#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/mpc_options.hpp"
#include "solvers/qp.hpp"

// The terms of the objective of a model predictive controller. Each is a sum of squares over the horizon in
// the planned MV positions relative to the last one, x = (v(0), ..., v(Hc-1)), v(i) = u(k+i) - u(k-1), and
// adds its part to the Hessian and to the gradient of 1/2 x'Hx + g'x. A controller is the sum of the terms
// that it needs: (2.26), (3.8) and (3.30) have moves and setpoints, (3.33) moves alone, (6.20) moves and
// targets. Weights are in the convention of the options.

namespace mpm {

/// The factors of the squares of a group of variables: the weights Q, or their squares.
Eigen::VectorXd effective_weight(const Eigen::VectorXd& weight, WeightConvention convention);

/// What the terms refer to at one sample.
///
/// | symbol    | member   | shape   | meaning                                          |
/// |-----------|----------|---------|--------------------------------------------------|
/// | y_free    | free     | ny x Hp | free response, output bias included              |
/// | u(k-1)    | previous | nu      | MVs that act until this sample                   |
/// | u_target  | target   | nu      | targets of the optimizer                         |
/// | y_set     | setpoint | ny      | setpoints, held over the horizon                 |
/// | y(k)      | measured | ny      | measured CVs                                     |
struct MpcSample {
  const Eigen::Ref<const Eigen::MatrixXd>& free;
  const Eigen::Ref<const Eigen::VectorXd>& previous;
  const Eigen::Ref<const Eigen::VectorXd>& target;
  const Eigen::Ref<const Eigen::VectorXd>& setpoint;
  const Eigen::Ref<const Eigen::VectorXd>& measured;
};

/// sum_{i=0}^{Hc-1} sum_j Q_du,j |v_j(i) - v_j(i-1)|^2,  v(-1) = 0. Constant; it adds nothing to the
/// gradient.
class MoveSuppression {
 public:
  explicit MoveSuppression(const MpcOptions& options);
  void add_hessian(Eigen::MatrixXd& hessian) const;

 private:
  int control_horizon_;
  Eigen::VectorXd weight_;
};

/// sum_{i=0}^{Hp-1} sum_j Q_u,j |u_j(k+i) - u_target,j|^2,  each planned position held until the next.
class TargetTracking {
 public:
  explicit TargetTracking(const MpcOptions& options);
  void add_hessian(Eigen::MatrixXd& hessian) const;
  void add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const;

 private:
  std::vector<double> samples_held_;  ///< of each planned position
  Eigen::VectorXd weight_;
};

/// sum_{l=1}^{Hp} sum_j Q_y,j |y_j(k+l) - r_j(k+l)|^2 over the CVs with a setpoint weight above 0. The sums
/// of (2.26) and (6.20) begin at the sample k itself, which no move can change any more. r is y_set or, if
/// the CV has a reference time, the trajectory
///     r_j(k+l) = y_set,j + (y_j(k) - y_set,j) e^{-l Ts / tau_ref,j}.
class SetpointTracking {
 public:
  /// `forced` is the matrix of forced_response(), with the rows cv * Hp + l - 1.
  SetpointTracking(const MpcOptions& options, const RowMajorMatrix& forced);
  void add_hessian(Eigen::MatrixXd& hessian) const;
  void add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const;

 private:
  struct TrackedCv {
    Eigen::Index cv;
    double weight;
    RowMajorMatrix forced;      ///< Hp x (nu Hc)
    Eigen::VectorXd from_here;  ///< e^{-l Ts / tau_ref}, Hp; empty: at once
  };
  std::vector<TrackedCv> tracked_;
};

}  // namespace mpm
