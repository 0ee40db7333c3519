#pragma once

#include <memory>

#include "plants/plant.hpp"

namespace mpm {

/// A plant in deviation variables, as a controller on a linear model sees it:
///
///   y = y_plant - y_operating,   u = u_plant - u_operating.
class DeviationPlant final : public Plant {
 public:
  /// The operating point is the steady state of `plant` under `operating_input`. Errors: InputError when
  /// there is no plant, or as Plant::reset().
  DeviationPlant(std::unique_ptr<Plant> plant, const Eigen::Ref<const Eigen::VectorXd>& operating_input);

  Eigen::Index output_count() const override { return plant_->output_count(); }
  Eigen::Index input_count() const override { return plant_->input_count(); }
  double sample_time() const override { return plant_->sample_time(); }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  void require_size(Eigen::Index found) const;

  std::unique_ptr<Plant> plant_;
  Eigen::VectorXd operating_input_, operating_output_;
  Eigen::VectorXd input_, output_;
};

}  // namespace mpm
