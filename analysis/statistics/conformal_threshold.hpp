#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace mpm {

/// Returns the threshold t that a further score of the same kind exceeds with a probability of at most
/// `false_alarms` = a. It assumes nothing about the distribution of the scores (split conformal prediction:
/// Vovk, Gammerman and Shafer 2005; Lei et al. 2018). With n scores in ascending order,
///
///   t = s_(k),   k = ceil((n + 1)(1 - a)),   P(s_(n+1) > t) <= a
///
/// if s_1 ... s_(n+1) are exchangeable, like the scores of loops that differ in their random numbers only.
/// The probability is an average over all draws of the n scores. For one given set of n scores it is itself
/// random: for scores without ties it has a Beta distribution with the parameters n + 1 - k and k, so that
/// 200 scores give 2.4 to 8.4 % (95 % of the time) at a = 5 %. A score that is NaN counts as -infinity: it
/// never speaks for a fault.
///
/// Returns none if n is below fewest_scores(), because then none of the n scores is large enough.
/// @throws InputError unless 0 < false_alarms < 1
std::optional<double> conformal_threshold(std::span<const double> scores, double false_alarms);

/// Returns the smallest n for which k <= n: 19 scores for 5 %, 99 for 1 %.
/// @throws InputError unless 0 < false_alarms < 1
std::int64_t fewest_scores(double false_alarms);

}  // namespace mpm
