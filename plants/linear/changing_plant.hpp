#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/linear_plant.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/plant.hpp"

namespace mpm {

/// A linear plant that changes from one transfer matrix to another while it runs. a(k), from 0 to 1, is the
/// share of the change that is complete. Let a channel change from G to H = f H1, where H1 has the static
/// gain of G. Its output is
///
///   y(k) = (1 - a(k)) G w + a(k) H1 w,   w(k) = (1 + (f - 1) a(k)) u(k).
///
/// The gain changes at the input and the dynamics change at the output. A plant at rest therefore stays where
/// it is when its time constant or its dead time changes, and moves through its own lag when its gain
/// changes. If G or H has no static gain or the gain 0, f = 1.
class ChangingPlant final : public Plant {
 public:
  /// `share` is a(k), one number for each sample; afterwards the last one holds. a(k) applies to the sample
  /// time before sample k, so that means (OutputSampling::average) change by the same share. Errors:
  /// InputError for matrices of different size, no share, a share outside [0, 1], or as LinearPlant.
  ChangingPlant(const TransferMatrix& before, const TransferMatrix& after, double sample_time,
                Eigen::VectorXd share, OutputSampling sampling = OutputSampling::snapshot);

  Eigen::Index output_count() const override { return output_.size(); }
  Eigen::Index input_count() const override { return unchanged_.input_count(); }
  double sample_time() const override { return unchanged_.sample_time(); }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  struct Channel {
    Eigen::Index row, col;
    double gain_factor;  ///< f
  };

  double share() const { return share_(std::min(sample_, share_.size() - 1)); }
  void weigh(const Eigen::Ref<const Eigen::VectorXd>& input);
  void measure();

  Eigen::VectorXd share_;
  std::vector<Channel> channels_;  ///< channels that change
  LinearPlant unchanged_;          ///< the other channels
  LinearPlant changing_;           ///< outputs 2i and 2i + 1: G and H1 of channel i under its w
  Eigen::VectorXd w_, output_;
  Eigen::Index sample_ = 0;
};

}  // namespace mpm
