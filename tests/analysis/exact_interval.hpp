#pragma once

#include <cstdint>

#include <boost/math/distributions/beta.hpp>

#include "analysis/statistics/interval.hpp"

namespace mpm::testing {

/// The exact interval of Clopper and Pearson (1934): each end is the p for which a result as extreme as
/// `hits` of `total` or more has the probability (1 - confidence)/2. Covers the truth with at least
/// `confidence` for every p, so that a test of a rate has the false alarms that it says.
inline Interval clopper_pearson_interval(std::int64_t hits, std::int64_t total, double confidence = 0.95) {
  const auto quantile = [](std::int64_t a, std::int64_t b, double probability) {
    return boost::math::quantile(
        boost::math::beta_distribution<>(static_cast<double>(a), static_cast<double>(b)), probability);
  };
  const double tail = (1.0 - confidence) / 2.0;
  return {hits == 0 ? 0.0 : quantile(hits, total - hits + 1, tail),
          hits == total ? 1.0 : quantile(hits + 1, total - hits, 1.0 - tail)};
}

}  // namespace mpm::testing
