#include "scenarios/study/study.hpp"

#include <algorithm>
#include <cstddef>

namespace mpm {

bool Study::has_plain_faults() const {
  const auto none_after = [](const auto& weights, std::ptrdiff_t plain) {
    return std::all_of(weights.begin() + plain, weights.end(), [](double weight) { return weight == 0.0; });
  };
  return experiments.other == 0 && none_after(mismatch.parameter_weight, 3) &&
         none_after(mismatch.extent_weight, 1) && mismatch.plant_parameters.empty() &&
         none_after(disturbance.signal_weight, 1) && none_after(disturbance.place_weight, 1) &&
         !asks_for_impact() && onset == OnsetRanges{};
}

TransferFunction Study::assessed_channel(Eigen::Index cv, Eigen::Index input) const {
  const TransferFunction& channel = plant.G(cv, input);
  return plant.G.is_integrating(cv) && !channel.is_zero() ? channel.behind_washout(washout()) : channel;
}

TransferMatrix Study::assessed_model() const {
  TransferMatrix model = plant.G;
  for (Eigen::Index cv = 0; cv < model.rows(); ++cv)
    for (Eigen::Index input = 0; input < model.cols(); ++input)
      model(cv, input) = assessed_channel(cv, input);
  return model;
}

double Study::washout() const {
  return assessment.washout > 0 ? assessment.washout : controller.prediction_horizon * controller.sample_time;
}

}  // namespace mpm
