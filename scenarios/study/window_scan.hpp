#pragma once

#include <Eigen/Core>

#include "scenarios/study/study.hpp"

namespace mpm {

/// The shortest moving window, in samples. The mean and the variance of a window use up two degrees of
/// freedom of the higher moments: two samples have skewness 0 and kurtosis 1, and three have kurtosis 3/2,
/// whatever their values are.
inline constexpr int kShortestWindow = 4;

/// A window length takes part in a mean only with this many pairs of moments: below it, chance alone makes a
/// |correlation| of about 0.18 = sqrt(2/(20 pi)), above the threshold 0.1 of the indicator.
inline constexpr Eigen::Index kFewestCorrelatedPairs = 20;

/// The window lengths of a scan, in samples: shortest, shortest + stride, ... up to `longest` at most.
struct WindowScan {
  int shortest = 0;
  int longest = 0;
  int stride = 1;

  /// Number of window lengths, n_MW.
  int count() const { return (longest - shortest) / stride + 1; }

  /// @throws InputError unless kShortestWindow <= shortest <= longest and 1 <= stride
  void validate() const;
};

/// The window lengths of (6.13) and (6.14) for a study, not validated: those between
/// `diagnosis.shortest_window` and `diagnosis.longest_window` prediction horizons. Half a sample is rounded
/// up at the short end, as in the thesis: half of Hp = 11 is 6.
WindowScan window_scan(const Study& study);

}  // namespace mpm
