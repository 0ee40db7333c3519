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

}  // namespace mpm
