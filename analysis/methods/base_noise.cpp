#include "analysis/methods/base_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kFewestSamples = 10;
constexpr Eigen::Index kTimeConstants = 10, kRatios = 12;
constexpr double kSmallestRatio = 0.02, kLargestRatio = 50.0;  // of b to the white noise
constexpr double kFastest = 1.0;                               // time constant, samples
constexpr double kOutlier = 6.0;                               // standard deviations
constexpr double kDeviationOfMedian = 1.4826;                  // of absolute deviations of a normal variable
constexpr double kSpreads = 2.0;                               // ranges of the neighbours
constexpr std::array<Eigen::Index, 4> kNeighbours{-2, -1, 1, 2};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// All AR(1) states under white noise of a grid.
NoiseModels grid_of_models(Eigen::Index samples) {
  NoiseModels models{Eigen::ArrayXd(kTimeConstants * kRatios), Eigen::ArrayXd(kTimeConstants * kRatios), 0.0,
                     false};
  const double slowest = std::max(2.0 * kFastest, 0.5 * static_cast<double>(samples));
  for (Eigen::Index i = 0; i < kTimeConstants; ++i)
    for (Eigen::Index j = 0; j < kRatios; ++j) {
      const double tau =
          kFastest * std::pow(slowest / kFastest, static_cast<double>(i) / (kTimeConstants - 1));
      models.a(i * kRatios + j) = std::exp(-1.0 / tau);
      models.b(i * kRatios + j) =
          kSmallestRatio * std::pow(kLargestRatio / kSmallestRatio, static_cast<double>(j) / (kRatios - 1));
    }
  return models;
}

/// Lag-one autocorrelation over the pairs of samples that are there.
double lag_one(const Eigen::Ref<const Eigen::RowVectorXd>& e, double mean_square, Eigen::Index& pairs) {
  double sum = 0.0;
  pairs = 0;
  for (Eigen::Index k = 1; k < e.size(); ++k)
    if (!std::isnan(e(k)) && !std::isnan(e(k - 1))) {
      sum += e(k) * e(k - 1);
      ++pairs;
    }
  return pairs == 0 ? 0.0 : std::clamp(sum / static_cast<double>(pairs) / mean_square, -0.95, 0.95);
}

}  // namespace

BaseNoise fitted_base_noise(const Eigen::Ref<const Eigen::RowVectorXd>& e, double least) {
  const Eigen::Index count = (!e.array().isNaN()).count();
  if (count < kFewestSamples)
    throw InputError("simulation errors of the benchmark", fmt::format("{} samples", count),
                     fmt::format("{} or more", kFewestSamples));
  const auto n = static_cast<double>(count);
  const double mean_square = e.array().isNaN().select(0.0, e.array()).square().sum() / n;
  BaseNoise noise{std::max(std::sqrt(mean_square), least)};
  if (mean_square <= least * least)
    return noise;
  double best = -0.5 * n * std::log(mean_square);
  Eigen::Index pairs = 0;
  const double phi = lag_one(e, mean_square, pairs);
  const double of_autoregression =
      best - 0.5 * static_cast<double>(pairs) * std::log(1.0 - phi * phi) - 0.5 * std::log(n);
  if (of_autoregression > best) {
    best = of_autoregression;
    noise.phi = phi;
  }
  const NoiseModels models = grid_of_models(e.size());
  const WhitenedProducts sums = whitened_products(models, Eigen::RowVectorXd(e));
  for (Eigen::Index i = 0; i < models.count(); ++i) {
    const double variance = sums.of(0, 0)(i) / n;
    const double of_state = -0.5 * sums.log_determinant(i) - 0.5 * n * std::log(variance) - std::log(n);
    if (of_state > best) {
      best = of_state;
      noise = {std::max(std::sqrt(variance), least), 0.0, models.a(i), models.b(i)};
    }
  }
  return noise;
}

Eigen::RowVectorXd without_outliers(const Eigen::Ref<const Eigen::RowVectorXd>& e) {
  Eigen::RowVectorXd off = Eigen::RowVectorXd::Constant(e.size(), kNaN), spread = off;
  std::vector<double> distances;
  for (Eigen::Index k = 0; k < e.size(); ++k) {
    std::vector<double> around;
    for (const Eigen::Index step : kNeighbours)
      if (k + step >= 0 && k + step < e.size() && !std::isnan(e(k + step)))
        around.push_back(e(k + step));
    if (std::isnan(e(k)) || around.size() < 3)
      continue;
    const auto [least, largest] = std::minmax_element(around.begin(), around.end());
    spread(k) = *largest - *least;
    off(k) = std::abs(e(k) - median(std::move(around)));
    distances.push_back(off(k));
  }
  if (distances.empty())
    return e;
  const double limit = kOutlier * kDeviationOfMedian * median(std::move(distances));
  Eigen::RowVectorXd kept = e;
  for (Eigen::Index k = 0; k < e.size(); ++k)
    if (limit > 0.0 && off(k) > limit && off(k) > kSpreads * spread(k))
      kept(k) = kNaN;
  return kept;
}

}  // namespace mpm
