#include "analysis/statistics/mcnemar.hpp"

#include <algorithm>

#include <boost/math/distributions/binomial.hpp>
#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_count(const char* name, std::int64_t count) {
  if (count < 0)
    throw InputError(name, fmt::format("{}", count), "0 or more");
}

/// P(X >= least) for X ~ B(trials, 1/2).
double upper_tail(std::int64_t least, std::int64_t trials) {
  if (least <= 0)
    return 1.0;
  const boost::math::binomial_distribution<> fair(static_cast<double>(trials), 0.5);
  return boost::math::cdf(boost::math::complement(fair, static_cast<double>(least - 1)));
}

}  // namespace

McNemarTest mcnemar_test(std::int64_t lost, std::int64_t gained) {
  require_count("number of losses", lost);
  require_count("number of gains", gained);
  const std::int64_t disagreements = lost + gained;
  return {lost, gained, std::min(1.0, 2.0 * upper_tail(std::max(lost, gained), disagreements)),
          upper_tail(lost, disagreements)};
}

}  // namespace mpm
