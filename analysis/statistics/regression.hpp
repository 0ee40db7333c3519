#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {

/// A least-squares line y = intercept + slope x,
///
///   slope = Sxy/Sxx,   intercept = mean y - slope mean x,   R^2 = Sxy^2/(Sxx Syy)
///
/// with the centred sums Sxx, Sxy, Syy. Pairs with a NaN or an infinity (an index without a denominator) are
/// left out and counted. All three results are NaN if there are fewer than 3 pairs or if x has no variance
/// beyond rounding; R^2 alone is NaN if y has none.
struct LinearFit {
  double slope = kNaN;
  double intercept = kNaN;
  /// Coefficient of determination: the share of the variance of y that the line explains. With one regressor
  /// it is the square of Pearson's correlation.
  double r_squared = kNaN;
  /// Number of pairs in the fit.
  Eigen::Index pairs = 0;
  /// Number of pairs left out because a member is NaN or infinite.
  Eigen::Index left_out = 0;
};

/// Options of `cluster_bootstrap`.
struct ClusterBootstrapOptions {
  /// Number of resamples.
  int replications = 2000;
  /// Confidence level of the intervals.
  double confidence = 0.95;

  /// @throws InputError unless replications >= 100 and 0 < confidence < 1
  void validate() const;
};

/// A fit with studentised intervals.
struct LinearFitIntervals {
  LinearFit fit;
  Interval slope;
  Interval intercept;
  Interval r_squared;
  /// Number of clusters with at least one pair in the fit.
  Eigen::Index clusters = 0;
  /// Number of resamples that gave a line and an R^2; the intervals rest on these.
  int replications_used = 0;
};

/// Fits the line, without intervals. Throws InputError if the lengths differ.
LinearFit linear_fit(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& y);

/// Fits the line, with intervals by the studentised cluster bootstrap (Davison and Hinkley 1997, sections 3.8
/// and 5.2), m out of n. Each resample draws half as many whole clusters as there are (but at least 5), with
/// replacement, and fits the line to their pairs. With t = (result of a resample - result)/standard error of
/// the resample, where that error comes from the influences of its clusters, and the jackknife's standard
/// error s of the result, the interval is
///
///   result - s t(1 - a/2) to result - s t(a/2),   a = 1 - confidence
///
/// with the quantiles t() of the resamples (interpolated between order statistics). R^2 is studentised as
/// Fisher's z = artanh r. If a few experiments determine the line, as experiments with a large Ivar do,
/// percentile intervals are too short, and intervals from resamples of full size are a little too short. The
/// bootstrap with fewer than n observations also holds for heavy tails (Bickel, Goetze and van Zwet 1997,
/// Statistica Sinica 7). The coverage of all three is in docs/methods_thesis.md. The clusters are the
/// experiments, because the controlled variables of one experiment share its mismatch and disturbance and are
/// not independent pairs.
///
/// The pairs of a cluster enter through their sums only, so that a resample costs O(clusters). The result
/// depends on the numbers of `stream` and on the order of the pairs within a cluster, not on the order of the
/// clusters.
///
/// | symbol  | meaning | shape | unit |
/// |---------|---------|-------|------|
/// | x, y    | pairs   | n     | any  |
/// | cluster | number of the experiment that a pair belongs to | n | - |
///
/// A resample is left out and counted if it has no line or no R^2, or if all its pairs lie on its line within
/// rounding. If there are fewer than 5 clusters, or if more than half of the resamples are left out, the ends
/// of the intervals are NaN. If all pairs lie on the line, both ends equal the result.
/// @throws InputError when the lengths differ or the options are invalid
LinearFitIntervals cluster_bootstrap(const Eigen::Ref<const Eigen::VectorXd>& x,
                                     const Eigen::Ref<const Eigen::VectorXd>& y,
                                     std::span<const std::int64_t> cluster, RandomStream& stream,
                                     const ClusterBootstrapOptions& options = {});

}  // namespace mpm
