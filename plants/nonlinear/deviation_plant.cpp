#include "plants/nonlinear/deviation_plant.hpp"

#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

DeviationPlant::DeviationPlant(std::unique_ptr<Plant> plant,
                               const Eigen::Ref<const Eigen::VectorXd>& operating_input)
    : plant_(std::move(plant)), operating_input_(operating_input) {
  if (!plant_)
    throw InputError("plant of a deviation plant", "none", "a plant");
  plant_->reset(operating_input_);
  operating_output_ = plant_->output();
  input_ = operating_input_;
  output_.setZero(operating_output_.size());
}

void DeviationPlant::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  require_size(steady_input.size());
  input_ = operating_input_ + steady_input;
  plant_->reset(input_);
  output_ = plant_->output() - operating_output_;
}

PlantStatus DeviationPlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  require_size(input.size());
  input_ = operating_input_ + input;
  const PlantStatus status = plant_->advance(input_);
  output_ = plant_->output() - operating_output_;
  return status;
}

void DeviationPlant::require_size(Eigen::Index found) const {
  if (found != input_count())
    throw InputError("number of plant inputs", fmt::format("{}", found), fmt::format("{}", input_count()));
}

}  // namespace mpm
