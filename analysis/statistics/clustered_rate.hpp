#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// The share p of all trials of several strata, with an interval for clusters that are drawn at random within
/// their stratum (Rate::clusters).
///
/// Over the strata s with the shares p_s, each with W_s clusters of h hits in n_w trials, the variance of p
/// is
///
///     v = sum_s W_s / (W_s - 1) sum_w (h_w - p_s n_w)^2 / n^2,    n all trials,
///
/// p_s (1 - p_s) n_s / n^2 for a stratum with a single cluster, whose trials count as independent.
/// n* = p (1 - p) / v independent trials would have this variance. The interval is Wilson's for a share p of
///
///     min(n, n* (z / t)^2)
///
/// trials, z and t the two-sided quantiles of the normal distribution and of Student's with sum_s (W_s - 1)
/// degrees of freedom: the device of Korn and Graubard (1998), "Confidence intervals for proportions with
/// small expected number of positive counts estimated from survey data", Survey Methodology 24, 193-201, with
/// Wilson's interval. Without scatter (all hits, or none) n* is n. Where no stratum has two clusters it is
/// rate().
///
/// `further_variance` is that of p for another reason, such as a threshold that was estimated. It is added to
/// v, and p of p (1 - p) is then that of half a hit and half a miss more, so that n* is not 0 where all are
/// hits.
/// @throws InputError unless 0 <= hits <= total in each cluster and 0 < confidence < 1
Rate clustered_rate(std::span<const std::vector<ClusterCount>> strata, double confidence = 0.95,
                    double further_variance = 0.0);

/// The same of one stratum. The rate keeps its clusters.
Rate clustered_rate(std::vector<ClusterCount> clusters, double confidence = 0.95,
                    double further_variance = 0.0);

/// The mean of values between 0 and 1 in strata of clusters, with the same interval: a value x counts as x
/// hits in one trial. Of nothing: NaN.
/// @throws InputError unless 0 <= sum <= count in each cluster and 0 < confidence < 1
Estimate clustered_mean(std::span<const std::vector<ClusterSum>> strata, double confidence = 0.95);

/// The same of one stratum. The estimate keeps its clusters.
Estimate clustered_mean(std::vector<ClusterSum> clusters, double confidence = 0.95);

}  // namespace mpm
