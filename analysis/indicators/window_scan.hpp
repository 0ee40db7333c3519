#pragma once

namespace mpm {

/// The window lengths of a scan, in samples: shortest, shortest + stride, ... up to `longest` at most.
struct WindowScan {
  int shortest = 0;
  int longest = 0;
  int stride = 1;

  /// Number of window lengths, n_MW.
  int count() const { return (longest - shortest) / stride + 1; }

  /// @throws InputError unless 3 <= shortest <= longest and 1 <= stride
  void validate() const;
};

/// The shortest window of a scan: two samples have skewness 0 and kurtosis 1, whatever they are.
inline constexpr int kShortestWindow = 3;

/// Every length from 0.5 Hp to 2 Hp, the scan of the thesis (6.13). Half a sample is rounded up, as there:
/// Hp = 11 is scanned from 6 to 22.
/// @throws InputError when the prediction horizon is below 5 samples
WindowScan default_window_scan(int prediction_horizon);

}  // namespace mpm
