#pragma once

#include <cstdint>

#include "analysis/statistics/interval.hpp"

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

/// Of shares of different cases: Newcombe's interval (1998, Statistics in Medicine 17:873, method 10), which
/// is the one above with phi = 0, and p of Fisher's exact test, the probability of all tables with these
/// margins that are no likelier than the one found. All NaN when one of them has no trials.
/// @throws InputError for a negative number, or unless 0 < confidence < 1
ShareDifference independent_difference(const Rate& first, const Rate& second, double confidence = 0.95);

}  // namespace mpm
