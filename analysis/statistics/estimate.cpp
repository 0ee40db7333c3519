#include "analysis/statistics/estimate.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// Returns the largest l with P(B(n, 1/2) < l) <= probability; 0 if no l above 0 satisfies this.
std::size_t order_below(std::size_t n, double probability) {
  const boost::math::binomial_distribution<> fair(static_cast<double>(n), 0.5);
  std::size_t order = 0;
  while (order < n && boost::math::cdf(fair, static_cast<double>(order)) <= probability)
    ++order;
  return order;
}

}  // namespace

Estimate mean_estimate(const std::vector<double>& values) {
  Estimate mean{.count = static_cast<std::int64_t>(values.size())};
  if (!values.empty())
    mean.value = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return mean;
}

Estimate median_estimate(std::vector<double> values, double confidence) {
  require_confidence(confidence);
  const std::size_t n = values.size();
  Estimate median{.count = static_cast<std::int64_t>(n)};
  if (n == 0)
    return median;
  std::sort(values.begin(), values.end());
  median.value = n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  if (const std::size_t order = order_below(n, 0.5 * (1.0 - confidence)); order > 0)
    median.interval = {values[order - 1], values[n - order]};
  return median;
}

Estimate poisson_rate(std::int64_t events, double exposure, double confidence) {
  require_confidence(confidence);
  if (events < 0)
    throw InputError("number of events", fmt::format("{}", events), "0 or more");
  Estimate rate{.count = events};
  if (!(exposure > 0.0))
    return rate;
  const double tail = 0.5 * (1.0 - confidence);
  const auto expected = [](double probability, std::int64_t half_freedom) {
    return 0.5 *
           boost::math::quantile(
               boost::math::chi_squared_distribution<>(2.0 * static_cast<double>(half_freedom)), probability);
  };
  rate.value = static_cast<double>(events) / exposure;
  rate.interval = {events == 0 ? 0.0 : expected(tail, events) / exposure,
                   expected(1.0 - tail, events + 1) / exposure};
  return rate;
}

}  // namespace mpm
