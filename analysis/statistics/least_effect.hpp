#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/estimate.hpp"

namespace mpm {

/// The effect of one fault, and whether the fault was found.
struct EffectTrial {
  double effect;
  bool found;
  int cluster = 0;  ///< trials of one cluster are not independent
};

/// Returns the least effect above which faults are found with a probability of `power` or more: the effect at
/// which the isotonic regression of `found` on the effect (pool adjacent violators: the non-decreasing fit of
/// least squares) reaches `power`. Infinite if it never does; NaN if there are no trials. The interval
/// consists of percentiles over 200 resamples of the clusters with replacement, a pure function of `seed`. It
/// is rather short: an interval of 95 % contains the true value in about 85 % of cases.
/// @throws InputError unless 0 < confidence < 1
Estimate least_effect(std::vector<EffectTrial> trials, double power, double confidence, std::uint64_t seed);

}  // namespace mpm
