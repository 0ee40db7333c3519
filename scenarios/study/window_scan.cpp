#include "scenarios/study/window_scan.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

void WindowScan::validate() const {
  if (shortest < kShortestWindow) {
    throw InputError("shortest window", fmt::format("{} samples", shortest),
                     fmt::format("{} or more", kShortestWindow));
  }
  if (longest < shortest) {
    throw InputError("longest window", fmt::format("{} samples", longest),
                     fmt::format("{} (the shortest window) or more", shortest));
  }
  if (stride < 1) {
    throw InputError("stride of the window lengths", fmt::format("{} samples", stride), "1 or more");
  }
}

WindowScan window_scan(const Study& study) {
  const double hp = study.controller.prediction_horizon;
  return {static_cast<int>(std::ceil(study.diagnosis.shortest_window * hp)),
          static_cast<int>(std::floor(study.diagnosis.longest_window * hp)), study.diagnosis.window_stride};
}

}  // namespace mpm
