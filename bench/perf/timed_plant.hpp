#pragma once

#include "plants/plant.hpp"

namespace mpm {

/// A plant that knows how long its steps took.
class TimedPlant final : public Plant {
 public:
  /// `plant` must outlive this.
  explicit TimedPlant(Plant& plant) : plant_(plant) {}

  Eigen::Index output_count() const override { return plant_.output_count(); }
  Eigen::Index input_count() const override { return plant_.input_count(); }
  double sample_time() const override { return plant_.sample_time(); }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override { plant_.reset(steady_input); }
  const Eigen::VectorXd& output() const override { return plant_.output(); }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

  /// Processor time in advance() so far.
  double seconds() const { return seconds_; }

 private:
  Plant& plant_;
  double seconds_ = 0.0;
};

}  // namespace mpm
