#include "analysis/indicators/window_scan.hpp"

#include <fmt/format.h>

#include "plants/error.hpp"

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

WindowScan default_window_scan(int prediction_horizon) {
  constexpr int kShortestHorizon = 2 * kShortestWindow - 1;
  if (prediction_horizon < kShortestHorizon) {
    throw InputError("prediction horizon", fmt::format("{} samples", prediction_horizon),
                     fmt::format("{} or more for a scan of moving windows", kShortestHorizon));
  }
  return {(prediction_horizon + 1) / 2, 2 * prediction_horizon, 1};
}

}  // namespace mpm
