#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace mpm {

/// The threshold t above which a further score of the same sort falls with a probability of at most
/// `false_alarms` = a, without any assumption on how scores are distributed (split conformal prediction:
/// Vovk, Gammerman and Shafer 2005; Lei et al. 2018): of n scores in ascending order
///
///   t = s_(k),   k = ceil((n + 1)(1 - a)),   P(s_(n+1) > t) <= a
///
/// when s_1 ... s_(n+1) are exchangeable, as scores of loops are that differ in their random numbers only.
/// The probability is over the n scores, too. With given ones it is itself random: for scores without ties
/// Beta distributed with the parameters n + 1 - k and k, so that 200 scores give 2.4 to 8.4 % (95 % of the
/// time) at a = 5 %. A score that is NaN counts as -infinity: it never speaks for a fault.
///
/// None when n is below fewest_scores(): then no score of the n is large enough.
/// @throws InputError unless 0 < false_alarms < 1
std::optional<double> conformal_threshold(std::span<const double> scores, double false_alarms);

/// The smallest n with k <= n: 19 scores for 5 %, 99 for 1 %.
/// @throws InputError unless 0 < false_alarms < 1
std::int64_t fewest_scores(double false_alarms);

}  // namespace mpm
