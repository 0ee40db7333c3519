#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/estimate.hpp"

namespace mpm {

/// A fault of some effect, and whether it was found.
struct EffectTrial {
  double effect;
  bool found;
  int cluster = 0;  ///< trials of one cluster are alike
};

/// The least effect from which on faults are found with a probability of `power`: the effect at which the
/// isotonic regression of `found` on the effect (pool adjacent violators: the non-decreasing fit of least
/// squares) reaches it. Infinite where it never does; NaN without trials. The interval is that of percentiles
/// of 200 samples of the clusters with replacement, a pure function of `seed`. It is rather short: meant to
/// hold 95 %, it holds about 85.
/// @throws InputError unless 0 < confidence < 1
Estimate least_effect(std::vector<EffectTrial> trials, double power, double confidence, std::uint64_t seed);

}  // namespace mpm
