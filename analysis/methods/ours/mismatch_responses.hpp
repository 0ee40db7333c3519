#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/fault_priors.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {

/// The response of one channel to `u` (N samples), from the steady state of `initial_u`, or from zero for an
/// integrating channel: as LinearPlant, for one channel alone.
Eigen::RowVectorXd channel_response(const DiscreteChannel& channel,
                                    const Eigen::Ref<const Eigen::RowVectorXd>& u, double initial_u);

/// The part of the simulation error that a mismatch of one parameter of one channel explains,
///
///   m(theta) = (G(theta) - G0) u,
///
/// on a grid of sizes theta, and exactly at any one size. The parts that depend on the study only are
/// computed once.
class MismatchResponses {
 public:
  /// `nominal` is the channel G0.
  MismatchResponses(const TransferFunction& nominal, double sample_time, const SizePrior& prior);

  const SizePrior& prior() const { return prior_; }
  /// Ascending, over the whole range of possible sizes.
  const std::vector<double>& sizes() const { return sizes_; }
  /// Whether m(theta) = (theta - 1) G0 u, so that one series suffices.
  bool is_linear() const {
    return prior_.parameter == MismatchParameter::gain || prior_.parameter == MismatchParameter::sign;
  }
  /// m at every size, sizes x N, or G0 u alone (1 x N) if m is linear.
  Eigen::MatrixXd on_grid(const Eigen::Ref<const Eigen::RowVectorXd>& u, double initial_u) const;
  /// m at this size.
  Eigen::RowVectorXd at(double size, const Eigen::Ref<const Eigen::RowVectorXd>& u, double initial_u) const;
  /// dm / dtheta at this size, by a difference.
  Eigen::RowVectorXd slope(double size, const Eigen::Ref<const Eigen::RowVectorXd>& u,
                           double initial_u) const;

 private:
  DiscreteChannel channel_at(double size) const;

  SizePrior prior_;
  TransferFunction nominal_;
  double sample_time_;
  DiscreteChannel nominal_channel_;
  std::vector<double> sizes_;
  std::vector<DiscreteChannel> channels_;  ///< at these sizes; empty if m is linear
};

}  // namespace mpm
