#include "analysis/records/channel_health.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>

#include "analysis/statistics/best_candidate.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Usual size of the largest of several errors of the model, in standard deviations.
constexpr double kUsual = 2.0;

/// Returns the logarithm of the evidence of a part of the errors with e = X a + n, a ~ N(0, spread^2 I), and
/// n with a variance of its own, at least `least`. `weight` is how many independent samples one sample is
/// worth.
double part_evidence(ChannelErrorSums sums, double spread, double least, double weight) {
  const Eigen::Index p = sums.Xe.size();
  if (sums.n < 1.0)
    return 0.0;
  double variance = std::max(least, sums.ee / sums.n), evidence = 0.0;
  for (int pass = 0; pass < 4; ++pass) {
    const Eigen::LDLT<Eigen::MatrixXd> A(sums.XX * (weight / variance) +
                                         Eigen::MatrixXd::Identity(p, p) / (spread * spread));
    const Eigen::VectorXd a = A.solve(sums.Xe * (weight / variance));
    const double left = std::max(0.0, sums.ee - 2.0 * a.dot(sums.Xe) + a.dot(sums.XX * a));
    const double log_determinant =
        A.vectorD().array().max(1e-300).log().sum() + 2.0 * static_cast<double>(p) * std::log(spread);
    evidence = -0.5 * weight * (sums.n * std::log(variance) + left / variance) -
               0.5 * a.squaredNorm() / (spread * spread) - 0.5 * log_determinant;
    variance = std::max(least, left / sums.n);
  }
  return evidence;
}

/// Returns how many independent samples one sample is worth, (1 - rho) / (1 + rho). rho is the correlation of
/// successive samples of what the errors of both parts of a record leave; the later part begins at `place`.
double independent_share(const ChannelErrorFit& fit, const Eigen::VectorXd& before,
                         const Eigen::VectorXd& after, Eigen::Index place) {
  const Eigen::Index n = fit.e.size();
  Eigen::VectorXd left = fit.e;
  for (const auto& [first, count, a] :
       {std::tuple<Eigen::Index, Eigen::Index, const Eigen::VectorXd&>{0, place, before},
        {place, n - place, after}}) {
    left.segment(first, count) -= fit.X.middleRows(first, count) * a;
    if (count > 0)
      left.segment(first, count).array() -= left.segment(first, count).mean();
  }
  const double squares = left.squaredNorm();
  const double rho =
      squares > 0.0 ? std::clamp(left.head(n - 1).dot(left.tail(n - 1)) / squares, 0.0, 0.98) : 0.0;
  return (1.0 - rho) / (1.0 + rho);
}

}  // namespace

double error_score(const Eigen::VectorXd& a, double left, double noise) {
  const double off = a.size() > 0 ? a.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / kUsual : 0.0;
  return larger_or_nan(off, std::sqrt(left / noise));
}

std::vector<Eigen::Index> health_periods(Eigen::Index samples, Eigen::Index settling) {
  constexpr Eigen::Index kSettlings = 3, kMost = 8;
  const Eigen::Index count =
      std::clamp<Eigen::Index>(samples / std::max<Eigen::Index>(1, kSettlings * settling), 1, kMost);
  std::vector<Eigen::Index> begins;
  for (Eigen::Index period = 0; period < count; ++period)
    begins.push_back(samples * period / count);
  return begins;
}

std::vector<ChannelHistory> channel_histories(const ChannelErrorFit& fit, Eigen::Index cv,
                                              const std::vector<Eigen::Index>& begins, Eigen::Index samples,
                                              double threshold) {
  constexpr double kHalf = 0.5;
  std::vector<ChannelHistory> histories;
  for (const ChannelError& error : fit.errors)
    if (std::none_of(histories.begin(), histories.end(),
                     [&error](const ChannelHistory& history) { return history.input == error.input; }))
      histories.push_back({cv, error.input, {}});
  for (std::size_t period = 0; period < begins.size(); ++period) {
    const Eigen::Index end = period + 1 < begins.size() ? begins[period + 1] : samples;
    const PartialErrorFit part = fit_of(sums_between(fit, begins[period], end), fit.noise);
    for (ChannelHistory& history : histories) {
      ChannelPeriod seen{.visible = kInfinity};
      for (std::size_t i = 0; i < fit.errors.size(); ++i) {
        const ChannelError& error = fit.errors[i];
        const auto place = static_cast<Eigen::Index>(i);
        if (error.input != history.input)
          continue;
        if (error.parameter == MismatchParameter::gain)
          seen.visible =
              kUsual * threshold * error.deviation / std::max(1e-12, 1.0 - part.covariance(place, place));
        if (const double score = std::abs(part.a(place)) / kUsual; score >= seen.score) {
          seen.score = score;
          seen.parameter = error.parameter;
          seen.size =
              part.a(place) * error.deviation + (error.parameter == MismatchParameter::dead_time ? 0.0 : 1.0);
        }
      }
      seen.state = seen.score > threshold  ? ChannelState::wrong
                   : seen.visible <= kHalf ? ChannelState::good
                                           : ChannelState::in_doubt;
      history.periods.push_back(seen);
    }
  }
  return histories;
}

std::optional<FaultOnset> fault_onset(const ChannelErrorFit& fit, double threshold) {
  constexpr Eigen::Index kMostOnsets = 60, kFewest = 3;
  constexpr double kSpread = 10.0, kSure = 0.95, kTail = 0.025, kMuch = 0.5;
  constexpr double kLeast = 0.25;  // of the noise of differences
  const auto n = static_cast<Eigen::Index>(fit.samples.size());
  if (n < 4 * kMostOnsets || fit.errors.empty())
    return std::nullopt;
  const auto sample = [&fit, n](Eigen::Index block) {
    return block < kMostOnsets ? fit.samples[static_cast<std::size_t>(n * block / kMostOnsets)]
                               : fit.samples.back() + 1;
  };
  const auto errors_of = [&fit](Eigen::Index first, Eigen::Index end) {
    return fit_of(sums_between(fit, first, end), fit.noise);
  };
  const ChannelErrorSums all = sums_between(fit, sample(0), sample(kMostOnsets));
  const double least = kLeast * fit.noise;
  Eigen::VectorXd log_posterior = Eigen::VectorXd::Constant(kMostOnsets, -kInfinity);
  Eigen::Index best = 0;
  double top = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    // The best cut of the first pass tells the noise, and the noise tells how much a sample is worth.
    const double weight =
        pass == 0 ? 1.0
                  : independent_share(fit, errors_of(sample(0), sample(best)).a,
                                      errors_of(sample(best), sample(kMostOnsets)).a, n * best / kMostOnsets);
    const double whole =
        std::max(part_evidence(all, kSpread, least, weight), part_evidence(all, 1.0, least, weight));
    ChannelErrorSums earlier = all, later = all;
    earlier -= all;
    for (Eigen::Index block = 1; block < kMostOnsets; ++block) {
      const ChannelErrorSums moved = sums_between(fit, sample(block - 1), sample(block));
      earlier += moved;
      later -= moved;
      if (block >= kFewest && block <= kMostOnsets - kFewest)
        log_posterior(block) = part_evidence(earlier, 1.0, least, weight) +
                               part_evidence(later, kSpread, least, weight) - whole -
                               std::log(static_cast<double>(kMostOnsets));
    }
    top = log_posterior.maxCoeff(&best);
  }
  const Eigen::VectorXd share = (log_posterior.array() - top).exp();
  const double sum = share.sum();
  if (!(sum / (sum + std::exp(std::min(700.0, -top))) > kSure))
    return std::nullopt;
  const auto score_of = [&fit, &errors_of](Eigen::Index first, Eigen::Index end) {
    const PartialErrorFit part = errors_of(first, end);
    return error_score(part.a, part.left, fit.noise);
  };
  if (!(score_of(sample(0), sample(best)) <=
        std::max(threshold, kMuch * score_of(sample(best), sample(kMostOnsets)))))
    return std::nullopt;
  FaultOnset onset{sample(best), sample(best), sample(best)};
  double seen = 0.0;
  for (Eigen::Index block = 0; block < kMostOnsets; ++block) {
    if (seen <= kTail * sum)
      onset.earliest = std::min(onset.sample, sample(std::max<Eigen::Index>(0, block - 1)));
    seen += share(block);
    if (seen <= (1.0 - kTail) * sum)
      onset.latest = std::max(onset.sample, sample(std::min(kMostOnsets - 1, block + 1)));
  }
  return onset;
}

}  // namespace mpm
