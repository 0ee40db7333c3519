#include "analysis/methods/partial_correlation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/identification/residual_tests.hpp"
#include "analysis/statistics/interval.hpp"
#include "plants/error.hpp"

namespace mpm {

bool PartialCorrelation::is_strong(double weakest) const {
  return std::abs(peak) > std::max(band, weakest);  // false for NaN
}

PartialCorrelation partial_correlation(const Eigen::Ref<const Eigen::VectorXd>& eps1,
                                       const Eigen::Ref<const Eigen::VectorXd>& eps2, Eigen::Index min_lag,
                                       Eigen::Index max_lag, double confidence, Eigen::Index parameters) {
  const Eigen::Index N = eps1.size();
  if (parameters < 0 || parameters >= N)
    throw InputError("coefficients of a partial correlation", fmt::format("{}", parameters),
                     fmt::format("0 to {}", N - 1));
  if (min_lag < 0 || min_lag > max_lag)
    throw InputError("lags of a partial correlation", fmt::format("{} to {}", min_lag, max_lag),
                     "0 or more, in ascending order");
  const InputCorrelation correlation = input_correlation(eps2, eps1, max_lag, confidence);
  PartialCorrelation result;
  result.values = correlation.values.tail(max_lag - min_lag + 1);
  if (result.values.hasNaN())
    return result;
  const auto freedom = static_cast<double>(N - parameters);
  result.band = correlation.band * std::sqrt(static_cast<double>(N) / freedom);
  result.white_band = two_sided_normal_quantile(confidence) / std::sqrt(freedom);
  result.values.cwiseAbs().maxCoeff(&result.lag);
  result.peak = result.values(result.lag);
  result.lag += min_lag;
  return result;
}

}  // namespace mpm
