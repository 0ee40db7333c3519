#pragma once

#include <cstdint>

namespace mpm {

/// Calibration loop i of a campaign is kept under the key kCalibrationKeys + i, experiment i under i.
inline constexpr std::int64_t kCalibrationKeys = std::int64_t{1} << 40;

}  // namespace mpm
