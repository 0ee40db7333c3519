#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// Returns the share p of hits among all trials of several strata. Its interval allows for clusters
/// (Rate::clusters) that are drawn at random within their stratum.
///
/// Stratum s has the share p_s and W_s clusters; cluster w has h_w hits in n_w trials. The variance of p is
///
///     v = sum_s W_s / (W_s - 1) sum_w (h_w - p_s n_w)^2 / n^2,    n all trials,
///
/// A stratum with a single cluster contributes p_s (1 - p_s) n_s / n^2, as if its trials were independent. n*
/// = p (1 - p) / v independent trials would have this variance. The interval is Wilson's for a share p of
///
///     min(n, n* (z / t)^2)
///
/// trials, where z and t are the two-sided quantiles of the normal distribution and of Student's distribution
/// with sum_s (W_s - 1) degrees of freedom. This is the method of Korn and Graubard (1998), "Confidence
/// intervals for proportions with small expected number of positive counts estimated from survey data",
/// Survey Methodology 24, 193-201, with Wilson's interval. If v is 0 (all hits, or none), n* is n. If no
/// stratum has two clusters, the result is that of rate().
///
/// `further_variance` is the variance that p has for another reason, such as an estimated threshold. It is
/// added to v. In p (1 - p), p then includes half a hit and half a miss more, so that n* is not 0 if all
/// trials are hits.
/// @throws InputError unless 0 <= hits <= total in each cluster and 0 < confidence < 1
Rate clustered_rate(std::span<const std::vector<ClusterCount>> strata, double confidence = 0.95,
                    double further_variance = 0.0);

/// clustered_rate() of one stratum. The rate keeps its clusters.
Rate clustered_rate(std::vector<ClusterCount> clusters, double confidence = 0.95,
                    double further_variance = 0.0);

/// Returns the mean of values between 0 and 1 in strata of clusters, with the interval of clustered_rate(): a
/// value x counts as x hits in one trial. NaN if there is no value.
/// @throws InputError unless 0 <= sum <= count in each cluster and 0 < confidence < 1
Estimate clustered_mean(std::span<const std::vector<ClusterSum>> strata, double confidence = 0.95);

/// clustered_mean() of one stratum. The estimate keeps its clusters.
Estimate clustered_mean(std::vector<ClusterSum> clusters, double confidence = 0.95);

}  // namespace mpm
