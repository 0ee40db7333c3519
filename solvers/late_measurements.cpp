#include "solvers/late_measurements.hpp"

#include <algorithm>

namespace mpm {

LateMeasurements::LateMeasurements(const LinearPlant& model, Eigen::Index mv_count,
                                   const std::vector<AnalyserTiming>& timings)
    : delay_(static_cast<Eigen::Index>(timings.size())), settled_(model) {
  std::transform(timings.begin(), timings.end(), delay_.begin(),
                 [](const AnalyserTiming& timing) { return timing.delay; });
  past_.setZero(mv_count + delay_.size(), std::max<Eigen::Index>(1, delay_.maxCoeff()));
  told_.setZero(delay_.size());
  output_before_ = model.output();
}

void LateMeasurements::reset(const LinearPlant& model, const Eigen::Ref<const Eigen::VectorXd>& input) {
  settled_ = model;
  told_ = input.tail(told_.size());
  sample_ = 0;
}

void LateMeasurements::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  if (sample_ >= past_.cols())
    settled_.advance(past(sample_));  // with the oldest input
  past(sample_) = input;
  ++sample_;
}

bool LateMeasurements::correct(const Eigen::Ref<const Eigen::VectorXd>& d, LinearPlant& model) {
  bool is_new = false;
  const Eigen::Index mv_count = past_.rows() - d.size();
  for (Eigen::Index md = 0; md < d.size(); ++md) {
    if (d(md) == told_(md))
      continue;
    for (Eigen::Index k = std::max<Eigen::Index>(0, sample_ - delay_(md)); k < sample_; ++k) {
      past(k)(mv_count + md) = d(md);
      is_new = true;
    }
  }
  told_ = d;
  if (!is_new)
    return false;
  model = settled_;
  for (Eigen::Index k = first_known(); k < sample_; ++k) {
    output_before_ = model.output();
    model.advance(past(k));
  }
  return true;
}

}  // namespace mpm
