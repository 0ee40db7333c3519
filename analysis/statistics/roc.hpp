#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {

/// The rates of the rule "positive if the score exceeds `threshold`".
///
/// | member              | meaning                                          | range        |
/// |---------------------|--------------------------------------------------|--------------|
/// | true_positive_rate  | share of the positives above the threshold (recall) | 0 ... 1   |
/// | false_positive_rate | share of the negatives above the threshold       | 0 ... 1      |
/// | precision           | share of positives among all above the threshold | 0 ... 1, NaN if none is |
struct RocPoint {
  double threshold;
  double true_positive_rate;
  double false_positive_rate;
  double precision;

  /// Youden's J = true positive rate - false positive rate; 0 for chance, 1 for no error (Youden 1950).
  double youden() const { return true_positive_rate - false_positive_rate; }
};

/// Scores in descending order, without NaNs. Several curves may share them.
struct SortedScores {
  std::shared_ptr<const std::vector<double>> descending;
  std::int64_t left_out = 0;  ///< number of NaNs

  explicit SortedScores(std::vector<double> scores);
};

/// Receiver operating characteristic of a score, and precision against recall. With millions of scores the
/// points would take more memory than the scores, so each() computes them anew on every call.
struct RocCurve {
  std::vector<SortedScores> positive_scores, negative_scores;
  std::int64_t positives = 0;
  std::int64_t negatives = 0;
  std::int64_t left_out = 0;  ///< scores that are NaN
  std::size_t size = 0;       ///< number of points
  /// Area under the curve: the probability that a positive scores above a negative, ties counting half
  /// (Mann-Whitney); NaN if there are no positives or no negatives.
  double area = kNaN;
  /// Sum of precision times the step of recall, without interpolation; NaN as above.
  double average_precision = kNaN;
  RocPoint best{};  ///< the point with the largest J; of several, the one with the fewest false positives

  /// Returns whether there are both positives and negatives.
  bool defined() const { return positives > 0 && negatives > 0; }

  /// Visits one point for each way in which a threshold can divide the scores, from the threshold +infinity
  /// (nothing is positive) to -infinity (everything is positive). The other thresholds lie halfway between
  /// neighbouring scores.
  void each(const std::function<void(const RocPoint&)>& visit) const;
};

/// Returns the curve of these scores; NaNs are left out and counted. If there are no positives or no
/// negatives, only `positives`, `negatives` and `left_out` have a meaning.
RocCurve roc_curve(std::span<const double> positive_scores, std::span<const double> negative_scores);
RocCurve roc_curve(std::vector<SortedScores> positive_scores, std::vector<SortedScores> negative_scores);

/// Applies the rule "positive if the score exceeds `threshold`" to these scores, with NaNs left out. A rate
/// is NaN if it has no scores.
RocPoint roc_point(std::span<const double> positive_scores, std::span<const double> negative_scores,
                   double threshold);

/// Interval of an area under the curve by Newcombe (2006, method 5): all A with |A - area| <= z sqrt(V(A)),
///
///   V(A) = A (1 - A)/(m n) (1 + (N - 1) ((1 - A)/(2 - A) + A/(1 + A))),   N = (m + n)/2
///
/// with m positives and n negatives. V is Hanley and McNeil's variance, taken at A itself, as Wilson's
/// interval takes the variance of a rate. The interval stays within [0, 1] and does not shrink to a point at
/// an area of 0 or 1.
/// @throws InputError unless 0 <= area <= 1, positives and negatives are 1 or more and 0 < confidence < 1
Interval area_interval(double area, std::int64_t positives, std::int64_t negatives, double confidence = 0.95);

/// Options of `best_threshold_interval`.
struct ThresholdBootstrapOptions {
  int replications = 2000;   ///< number of resamples
  double confidence = 0.95;  ///< level of the interval

  /// @throws InputError unless replications >= 100 and 0 < confidence < 1
  void validate() const;
};

/// Returns the percentile interval of the threshold with the largest J. Each resample draws positives and
/// negatives with replacement and chooses the threshold anew. A resample whose threshold is infinite (no J
/// above 0) is left out. The ends are NaN if there are no positives or no negatives, or if more than half of
/// the resamples are left out.
/// @throws InputError for invalid options
Interval best_threshold_interval(std::span<const double> positive_scores,
                                 std::span<const double> negative_scores, RandomStream& stream,
                                 const ThresholdBootstrapOptions& options = {});

}  // namespace mpm
