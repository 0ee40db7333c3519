#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// The same cases counted twice: how many count both times, once, or never.
struct PairedCounts {
  std::int64_t both = 0;
  std::int64_t first = 0;   ///< the first time alone
  std::int64_t second = 0;  ///< the second time alone
  std::int64_t neither = 0;

  std::int64_t total() const { return both + first + second + neither; }
  void add(bool in_first, bool in_second);
};

/// How a share differs: second minus first.
struct ShareDifference {
  double value;
  Interval interval;
  double p;  ///< two-sided, of the hypothesis that there is no difference
};

/// Of two shares of the same cases. The interval is Newcombe's (1998, Statistics in Medicine 17:2635, method
/// 10): with the shares p1, p2 and their Wilson intervals l1 to u1 and l2 to u2
///
///   D - sqrt((p2 - l2)^2 - 2 phi (p2 - l2) (u1 - p1) + (u1 - p1)^2)   to
///   D + sqrt((u2 - p2)^2 - 2 phi (u2 - p2) (p1 - l1) + (p1 - l1)^2),  D = p2 - p1
///
/// where phi = X / sqrt(product of the four margins) with X = both neither - first second, of which half the
/// number of cases, but not more than X, is taken where X > 0; 0 where a margin is 0. The interval stays
/// within -1 and 1 and has a length where all cases agree. p is that of mcnemar_test(). All NaN without
/// cases.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference paired_difference(const PairedCounts& counts, double confidence = 0.95);

/// Of two shares of the same cases, which lie in clusters that are drawn at random. With first_w and second_w
/// cases of the n_w in cluster w that count one time alone, D the difference and n all cases, D has the
/// variance
///
///     v = W / (W - 1) sum_w (second_w - first_w - D n_w)^2 / n^2,    W clusters with a case,
///
/// where independent cases have v_0 = ((first + second) / n - D^2) / n. The interval is that of
/// paired_difference() for the same shares of
///
///     min(n, n (v_0 / v) (z / t)^2)
///
/// cases, as clustered_rate() has it, t with W - 1 degrees of freedom. p is that of clustered_mcnemar(). Of
/// one cluster, it is paired_difference().
///
/// A `further_variance` of D, such as that of the thresholds of both, lengthens either half of the interval:
/// the square of a half grows by z^2 times it. p is then at least that of a normal D of this variance and
/// that of the interval.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference clustered_difference(std::span<const PairedCounts> clusters, double confidence = 0.95,
                                     double further_variance = 0.0);

/// McNemar's test of cases in clusters that are drawn at random: with lost_w and gained_w of them in cluster
/// w,
///
///     t = sum_w d_w / sqrt(W / (W - 1) sum_w (d_w - mean d)^2),    d_w = lost_w - gained_w,
///
/// has Student's distribution with W - 1 degrees of freedom if neither is likelier. Each p-value is that of t
/// or that of mcnemar_test(), whichever is larger: clusters never make it more certain than independent
/// cases. PairedCounts::first are lost, second gained; of one cluster, it is mcnemar_test().
McNemarTest clustered_mcnemar(std::span<const PairedCounts> clusters);

/// The sum of all clusters.
PairedCounts pooled_counts(std::span<const PairedCounts> clusters);

/// Of shares of different cases: Newcombe's interval (1998, Statistics in Medicine 17:873, method 10), which
/// is the one above with phi = 0, and p of Fisher's exact test, the probability of all tables with these
/// margins that are no likelier than the one found. Of shares with clusters (Rate::clusters) the intervals
/// are those of clustered_rate(), and p at least that of a normal difference whose variances are as much
/// larger as the squares of these intervals. All NaN when one of them has no trials.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference independent_difference(const Rate& first, const Rate& second, double confidence = 0.95);

}  // namespace mpm
