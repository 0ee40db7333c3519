#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "plants/analyser.hpp"
#include "plants/linear/linear_plant.hpp"

namespace mpm {

/// The model of a controller that receives some MDs late. A new value d(k) was measured `delay` samples
/// before: the MD has had it since sample k - delay, while the model used an older one. The model is run
/// again over these samples. y_sim(k) then follows from all that is known at sample k, and what the
/// disturbance has already done to the outputs does not count as output bias.
class LateMeasurements {
 public:
  /// One timing for each MD; `model` has the MDs after the MVs.
  LateMeasurements(const LinearPlant& model, Eigen::Index mv_count,
                   const std::vector<AnalyserTiming>& timings);

  /// Starts at sample 0, at which `model` rests at `input` (nu + nd).
  void reset(const LinearPlant& model, const Eigen::Ref<const Eigen::VectorXd>& input);
  /// To be called when the model is advanced with `input` to the next sample.
  void advance(const Eigen::Ref<const Eigen::VectorXd>& input);
  /// If the MDs `d` (nd) that become known now change those of earlier samples, puts `model` at the corrected
  /// state of this sample and returns true. Allocates nothing.
  bool correct(const Eigen::Ref<const Eigen::VectorXd>& d, LinearPlant& model);
  /// The output of the corrected model at the sample before, ny.
  const Eigen::VectorXd& output_before() const { return output_before_; }

 private:
  Eigen::Index first_known() const { return std::max<Eigen::Index>(0, sample_ - past_.cols()); }
  auto past(Eigen::Index k) { return past_.col(k % past_.cols()); }

  Eigen::VectorX<Eigen::Index> delay_;  ///< of each MD
  LinearPlant settled_;                 ///< the model at the first sample whose input may still change
  Eigen::MatrixXd past_;                ///< inputs from there on, a ring of the longest delay
  Eigen::VectorXd told_;                ///< the MDs that were given at the last sample
  Eigen::VectorXd output_before_;
  Eigen::Index sample_ = 0;
};

}  // namespace mpm
