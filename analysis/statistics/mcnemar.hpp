#pragma once

#include <cstdint>

namespace mpm {

/// The result of McNemar's exact test of two methods that judge the same cases.
struct McNemarTest {
  std::int64_t lost = 0;    ///< cases that the first method gets right and the second does not
  std::int64_t gained = 0;  ///< cases that the second method gets right and the first does not
  double p_two_sided = 1.0;
  /// One-sided, against the alternative that the second method is worse.
  double p_worse = 1.0;
};

/// Tests the hypothesis that a case on which the methods disagree is as likely a loss as a gain (McNemar
/// 1947). The cases on which they agree say nothing about this, so that the number X of losses is binomial:
///
///   p_worse = P(X >= lost),   p_two_sided = min(1, 2 P(X >= max(lost, gained))),   X ~ B(lost + gained, 1/2)
///
/// Both are 1 if there is no disagreement. The test is exact rather than the chi-square approximation because
/// there are often few disagreements: 4 losses without a gain have p_worse = 1/16, 5 have 1/32.
/// @throws InputError for a negative number
McNemarTest mcnemar_test(std::int64_t lost, std::int64_t gained);

}  // namespace mpm
