#include "analysis/methods/ours/base_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/sample_spacing.hpp"
#include "analysis/statistics/truncated_normal.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kTimeConstants = 10, kRatios = 12;
constexpr double kSmallestRatio = 0.02, kLargestRatio = 50.0;  // of b to the white noise
constexpr double kFastest = 1.0;                               // time constant, samples
constexpr double kOutlier = 6.0;                               // standard deviations
constexpr double kDeviationOfMedian = 1.4826;                  // of absolute deviations of a normal variable
constexpr double kSpreads = 2.0;                               // ranges of the neighbours
constexpr double kLargestExplained = 20.0;  // log of the variance of e over that of the noise
constexpr double kGolden = 0.6180339887498949;
constexpr int kVarianceSteps = 40;
constexpr double kMuchLess = 15.0;         // of log L
constexpr double kNoWeightOfNoise = -6.0;  // logarithm of a posterior probability
constexpr double kUnseen = 0.1;            // prior probability of a background that the record does not show
constexpr std::array<Eigen::Index, 4> kNeighbours{-2, -1, 1, 2};

/// A grid of AR(1) states under white noise.
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

/// The models under which e, here without what directions explain, is not much less likely than under the
/// best.
NoiseModels likely_ones(const NoiseModels& models, const Eigen::Ref<const Eigen::MatrixXd>& e, double n) {
  const WhitenedProducts sums = whitened_products(models, e);
  const Eigen::ArrayXd log_likelihood = -0.5 * (sums.log_determinant + n * sums.of(0, 0).log());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < models.count(); ++i)
    if (log_likelihood(i) > log_likelihood.maxCoeff() - kMuchLess)
      kept.push_back(i);
  return {models.a(kept), models.b(kept), models.phi, models.starts_from_rest};
}

double sample_count(const Eigen::Ref<const Eigen::RowVectorXd>& e) {
  const Eigen::Index count = (!e.array().isNaN()).count();
  if (count < kFewestNoiseSamples)
    throw InputError("simulation errors of the benchmark", fmt::format("{} samples", count),
                     fmt::format("{} or more", kFewestNoiseSamples));
  return static_cast<double>(count);
}

/// The mean square of the samples that are there; at least one is.
double mean_square_of(const Eigen::RowVectorXd& e) {
  return e.array().isNaN().select(0.0, e.array()).square().sum() /
         static_cast<double>((!e.array().isNaN()).count());
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

/// The part of e that the directions Z explain under white noise: Z' (s^2 I + Z Z')^-1 Z e.
Eigen::RowVectorXd explained(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                             const Eigen::Ref<const Eigen::MatrixXd>& directions, double deviation) {
  const auto observed = [&e](auto&& row) {
    return e.array().isNaN().select(0.0, row.array()).matrix().eval();
  };
  const Eigen::Index q = directions.rows();
  Eigen::MatrixXd Z(q, e.size());
  for (Eigen::Index i = 0; i < q; ++i)
    Z.row(i) = observed(directions.row(i));
  const Eigen::MatrixXd inner = Z * Z.transpose() + deviation * deviation * Eigen::MatrixXd::Identity(q, q);
  return inner.llt().solve(Z * observed(e).transpose()).transpose() * directions;
}

/// Under one model: log L of e, and the variance of the noise at which it is largest,
///
///   log L = -(n log s^2 + log |I + W / s^2| + (e'e - (Ze)' (s^2 I + W)^-1 Ze) / s^2) / 2,    W = Z Z',
///
/// where all products are those of whitened series.
struct VarianceFit {
  double variance, log_likelihood;
};

VarianceFit fitted_variance(const WhitenedProducts& sums, Eigen::Index model, Eigen::Index q, double n,
                            double least) {
  const double squares = sums.of(0, 0)(model);
  Eigen::ArrayXd values(q), along(q);
  Eigen::MatrixXd inner(q, q);
  Eigen::VectorXd with_e(q);
  for (Eigen::Index i = 0; i < q; ++i) {
    with_e(i) = sums.of(1 + i, 0)(model);
    for (Eigen::Index j = 0; j < q; ++j)
      inner(i, j) = sums.of(1 + i, 1 + j)(model);
  }
  if (q > 0) {  // Eigen reads the largest element of an empty matrix
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inner);
    values = eigen.eigenvalues().array().max(0.0);
    along = (eigen.eigenvectors().transpose() * with_e).array().square();
  }
  const auto log_likelihood = [&](double log_variance) {
    const double s2 = std::exp(log_variance);
    return -0.5 * (sums.log_determinant(model) + n * log_variance + (values / s2).log1p().sum() +
                   (squares - (along / (values + s2)).sum()) / s2);
  };
  double high = std::log(std::max(squares / n, least * least)),
         low = std::max(2.0 * std::log(least), high - kLargestExplained);
  for (int step = 0; step < kVarianceSteps; ++step) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    if (log_likelihood(left) < log_likelihood(right))
      low = left;
    else
      high = right;
  }
  return {std::exp(0.5 * (low + high)), log_likelihood(0.5 * (low + high))};
}

}  // namespace

BaseNoise fitted_base_noise(const Eigen::Ref<const Eigen::RowVectorXd>& e, double least) {
  const double n = sample_count(e);
  const double mean_square = mean_square_of(e);
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

NoisePosterior noise_posterior(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                               const Eigen::Ref<const Eigen::MatrixXd>& directions, double least) {
  const double n = sample_count(e);
  const double mean_square = mean_square_of(e);
  NoisePosterior noise{{std::max(std::sqrt(mean_square), least)}, {}, 0.0};
  if (mean_square <= least * least)
    return noise;
  const Eigen::Index q = directions.rows();
  Eigen::MatrixXd series(1 + q, e.size());
  series << e, directions;
  double best = -kInfinity;
  // Considers all noises of one kind. They have this number of parameters besides the variance, and each has
  // this share of the prior.
  const auto consider = [&](const NoiseModels& models, double parameters, double log_share) {
    const WhitenedProducts sums = whitened_products(models, series);
    Eigen::ArrayXd all(models.count());
    for (Eigen::Index i = 0; i < models.count(); ++i) {
      const VarianceFit fit = fitted_variance(sums, i, q, n, least);
      all(i) = fit.log_likelihood;
      if (const double score = fit.log_likelihood - 0.5 * parameters * std::log(n); score > best) {
        best = score;
        noise.best = {std::max(std::sqrt(fit.variance), least), models.phi, models.a(i), models.b(i)};
      }
    }
    noise.possible.push_back({models.phi, models.a, models.b, all + log_share});
  };
  NoiseModels alone{Eigen::ArrayXd::Zero(1), Eigen::ArrayXd::Zero(1), 0.0, false};
  consider(alone, 0.0, 0.0);
  const Eigen::RowVectorXd of_directions = explained(e, directions, noise.best.deviation);
  Eigen::Index pairs = 0;
  alone.phi = lag_one(e - of_directions, mean_square_of(e - of_directions), pairs);
  const double width_of_phi = std::sqrt(2.0 * std::numbers::pi * (1.0 - alone.phi * alone.phi) / n);
  consider(alone, 1.0, std::log(width_of_phi / 2.0));
  const NoiseModels states = grid_of_models(e.size());
  consider(likely_ones(states, series.row(0) - of_directions, n), 2.0,
           -std::log(static_cast<double>(states.count())));
  double total = -kInfinity;
  for (const PossibleNoises& each : noise.possible)
    for (const double log_weight : each.log_weight)
      total = log_sum(total, log_weight);
  if (!std::isfinite(total))
    throw InputError("likelihoods of the noise of a CV", fmt::format("a sum of e^{}", total), "a number");
  noise.log_evidence = total;
  for (PossibleNoises& each : noise.possible) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < each.log_weight.size(); ++i)
      if (each.log_weight(i) > total + kNoWeightOfNoise)
        kept.push_back(i);
    each = {each.phi, each.a(kept), each.b(kept), each.log_weight(kept) - total};
  }
  std::erase_if(noise.possible, [](const PossibleNoises& each) { return each.a.size() == 0; });
  return noise;
}

Eigen::RowVectorXd drawn_noise(const BaseNoise& noise, Eigen::Index samples, RandomStream& random) {
  Eigen::RowVectorXd drawn(samples);
  double state = noise.b / std::sqrt(1.0 - noise.a * noise.a) * random.normal();
  double fast = random.normal();
  for (double& each : drawn) {
    each = state + fast;
    state = noise.a * state + noise.b * random.normal();
    fast = noise.phi * fast + std::sqrt(1.0 - noise.phi * noise.phi) * random.normal();
  }
  return noise.deviation * drawn;
}

double slow_part(const BaseNoise& noise) {
  const double state = noise.b / std::sqrt(1.0 - noise.a * noise.a);
  return std::max(state, noise.phi / std::sqrt(1.0 - noise.phi * noise.phi));
}

void add_unseen_backgrounds(NoisePosterior& noise, Eigen::Index samples) {
  const NoiseModels grid = grid_of_models(samples);
  std::vector<Eigen::Index> small;
  for (Eigen::Index i = 0; i < grid.count(); ++i)
    if (grid.b(i) <= kLargestBackground * std::sqrt(1.0 - grid.a(i) * grid.a(i)))
      small.push_back(i);
  for (PossibleNoises& each : noise.possible)
    each.log_weight += std::log(1.0 - kUnseen);
  const double share = std::log(kUnseen / static_cast<double>(small.size()));
  noise.possible.push_back({0.0, grid.a(small), grid.b(small),
                            Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(small.size()), share)});
}

double deviation_of_steps(const Eigen::Ref<const Eigen::RowVectorXd>& e) {
  const Eigen::Index spacing = sample_spacing(e.transpose());
  std::vector<double> steps;
  for (Eigen::Index k = spacing; k < e.size(); ++k)
    if (!std::isnan(e(k)) && !std::isnan(e(k - spacing)))
      steps.push_back(std::abs(e(k) - e(k - spacing)));
  return steps.empty() ? 0.0 : kDeviationOfMedian * upper_median(std::move(steps)) / std::sqrt(2.0);
}

Eigen::RowVectorXd without_outliers(const Eigen::Ref<const Eigen::RowVectorXd>& e) {
  const Eigen::Index spacing = sample_spacing(e.transpose());
  Eigen::RowVectorXd off = Eigen::RowVectorXd::Constant(e.size(), kNaN), spread = off;
  std::vector<double> distances;
  for (Eigen::Index k = 0; k < e.size(); ++k) {
    std::vector<double> around;
    for (const Eigen::Index neighbour : kNeighbours)
      if (const Eigen::Index other = k + neighbour * spacing;
          other >= 0 && other < e.size() && !std::isnan(e(other)))
        around.push_back(e(other));
    if (std::isnan(e(k)) || around.size() < 3)
      continue;
    const auto [least, largest] = std::minmax_element(around.begin(), around.end());
    spread(k) = *largest - *least;
    off(k) = std::abs(e(k) - upper_median(std::move(around)));
    distances.push_back(off(k));
  }
  if (distances.empty())
    return e;
  const double limit = kOutlier * kDeviationOfMedian * upper_median(std::move(distances));
  Eigen::RowVectorXd kept = e;
  for (Eigen::Index k = 0; k < e.size(); ++k)
    if (limit > 0.0 && off(k) > limit && off(k) > kSpreads * spread(k))
      kept(k) = kNaN;
  return kept;
}

}  // namespace mpm
