#pragma once

#include <cstdint>

namespace mpm {

/// Calibration loop i of a run has the key kCalibrationKeys + i, experiment i the key i.
inline constexpr std::int64_t kCalibrationKeys = std::int64_t{1} << 40;

}  // namespace mpm
