#pragma once

#include <Eigen/Core>

namespace mpm {

/// The stated accuracy of `moving_moments`: the error of a skewness relative to max(1, |skewness|) and the
/// relative error of a kurtosis (which is never below 1).
inline constexpr double kMovingMomentAccuracy = 1e-9;

/// Computes the skewness and kurtosis of every window of `window` consecutive samples of a signal:
///
///   skn = m3 / m2^(3/2),   kts = m4 / m2^2,   m_l = (1/MW) sum_i (x_i - mean x)^l   (6.10), (6.11), (6.12)
///
/// The thesis prints the two formulas in exchanged places, and the first with m3 in its denominator; these
/// are the usual ones.
///
/// | symbol   | meaning | shape | unit |
/// |----------|---------|-------|------|
/// | signal   | x       | N     | any |
/// | window   | MW      | -     | samples |
/// | skewness | skn, entry k for the samples k ... k + MW - 1 | N - MW + 1 | 1 |
/// | kurtosis | kts, same indices | N - MW + 1 | 1 |
///
/// If m2 of a window is zero to rounding, m2 <= (4 eps max|x|)^2 over the whole signal or m2 <= 1e-150, both
/// entries are NaN.
///
/// For ordinary signals the work is O(1) per window: power sums about a fixed centre are updated from window
/// to window. They are computed anew about the mean of the current window whenever their rounding error could
/// exceed the stated accuracy, for instance after the signal has moved far away or has become quiet.
/// Allocates nothing.
/// @throws InputError for a window outside 2 ... N, an output of the wrong size or a value that is not finite
void moving_moments(const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index window,
                    Eigen::Ref<Eigen::VectorXd> skewness, Eigen::Ref<Eigen::VectorXd> kurtosis);

}  // namespace mpm
