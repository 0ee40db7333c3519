#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// The same cases counted twice: the numbers of cases that count both times, only once, or never.
struct PairedCounts {
  std::int64_t both = 0;
  std::int64_t first = 0;   ///< the first time only
  std::int64_t second = 0;  ///< the second time only
  std::int64_t neither = 0;

  std::int64_t total() const { return both + first + second + neither; }
  void add(bool in_first, bool in_second);
};

/// The difference of two shares, second minus first.
struct ShareDifference {
  double value;
  Interval interval;
  double p;  ///< two-sided, of the hypothesis that there is no difference
};

/// Returns the difference of two shares of the same cases. The interval is Newcombe's (1998, Statistics in
/// Medicine 17:2635, method 10): with the shares p1, p2 and their Wilson intervals l1 to u1 and l2 to u2
///
///   D - sqrt((p2 - l2)^2 - 2 phi (p2 - l2) (u1 - p1) + (u1 - p1)^2)   to
///   D + sqrt((u2 - p2)^2 - 2 phi (u2 - p2) (p1 - l1) + (p1 - l1)^2),  D = p2 - p1
///
/// where phi = X / sqrt(product of the four margins) with X = both neither - first second. If X > 0, half the
/// number of cases is subtracted from X, but not more than X. phi is 0 if a margin is 0. The interval stays
/// within -1 and 1, and its length is above 0 even if all cases agree. p is that of mcnemar_test(). All are
/// NaN if there are no cases.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference paired_difference(const PairedCounts& counts, double confidence = 0.95);

/// Returns the difference of two shares of the same cases, which lie in clusters that are drawn at random. Of
/// the n_w cases in cluster w, first_w count the first time only and second_w the second time only. The
/// difference D of the shares of all n cases has the variance
///
///     v = W / (W - 1) sum_w (second_w - first_w - D n_w)^2 / n^2,    W clusters with a case,
///
/// whereas for independent cases it is v_0 = ((first + second) / n - D^2) / n. The interval is that of
/// paired_difference() for the same shares of
///
///     min(n, n (v_0 / v) (z / t)^2)
///
/// cases, with z and t as in clustered_rate(), t with W - 1 degrees of freedom. p is that of
/// clustered_mcnemar(). For one cluster, the result is that of paired_difference().
///
/// A `further_variance` of D, such as that of the two thresholds, lengthens both halves of the interval: the
/// square of each half grows by z^2 times `further_variance`. p is then at least that of a normal D whose
/// variance is the sum of this variance and that of the interval.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference clustered_difference(std::span<const PairedCounts> clusters, double confidence = 0.95,
                                     double further_variance = 0.0);

/// Runs McNemar's test on cases in clusters that are drawn at random: with lost_w losses and gained_w gains
/// in cluster w,
///
///     t = sum_w d_w / sqrt(W / (W - 1) sum_w (d_w - mean d)^2),    d_w = lost_w - gained_w,
///
/// has Student's distribution with W - 1 degrees of freedom if losses and gains are equally likely. Each
/// p-value is that of t or that of mcnemar_test(), whichever is larger: clusters never make the test more
/// certain than independent cases would. PairedCounts::first are the losses, second the gains. For one
/// cluster, the result is that of mcnemar_test().
McNemarTest clustered_mcnemar(std::span<const PairedCounts> clusters);

/// Returns the sum of all clusters.
PairedCounts pooled_counts(std::span<const PairedCounts> clusters);

/// Returns the difference of two shares of different cases. The interval is Newcombe's (1998, Statistics in
/// Medicine 17:873, method 10), which is that of paired_difference() with phi = 0. p is that of Fisher's
/// exact test: the probability of all tables with these margins that are no likelier than the one found. For
/// shares with clusters (Rate::clusters), the intervals of the shares are those of clustered_rate(), and p is
/// at least that of a normal difference whose variances are larger by the same factor as the squared lengths
/// of these intervals. All are NaN if one of the shares has no trials.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference independent_difference(const Rate& first, const Rate& second, double confidence = 0.95);

}  // namespace mpm
