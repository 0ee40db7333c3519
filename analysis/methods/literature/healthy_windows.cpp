#include "analysis/methods/literature/healthy_windows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr std::uint64_t kMachineSeed = 47;
constexpr double kLeastDiagonal = 1e-200;  ///< small, but with a finite root and reciprocal

/// (I + R C R')^-1/2 x, by the Cholesky factor.
Eigen::VectorXd standard_deviations(const Eigen::MatrixXd& R, const Eigen::MatrixXd& C,
                                    const Eigen::VectorXd& x) {
  Eigen::MatrixXd covariance = R * C * R.transpose();
  covariance.diagonal().array() += 1.0;
  return covariance.llt().matrixL().solve(x);
}

double exceeded_by_share(std::vector<double> values, double share) {
  if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
    return kNaN;
  std::sort(values.begin(), values.end(), std::greater<>());
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

}  // namespace

HealthyWindows::HealthyWindows(const PlantAndNoise& period, const WindowRule& rule)
    : rule_(rule), whole_(healthy_model(period)), noise_(noise_estimate(whole_.v, kHighestNoiseOrder)) {
  const Eigen::Index N = period.e.size();
  if (N <= rule.window)
    throw InputError("samples of a healthy period", fmt::format("{}", N),
                     fmt::format("more than a window of {}", rule.window));
  independent_ = static_cast<double>(N) / static_cast<double>(rule.window);
  own_deviation_ = std::sqrt(1.0 - 1.0 / independent_);
  Eigen::MatrixXd information = noise_.information;
  information.diagonal().array() += kLeastInformation * information.diagonal().maxCoeff();
  noise_covariance_ =
      information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  if (!(whole_.variance > 0.0))
    return;
  std::vector<Eigen::VectorXd> plants, noises;
  for (Eigen::Index number = 0; number < rule_.windows(N); ++number) {
    const PlantAndNoise window = window_of(period, number);
    plants.push_back(plant_point(window, true));
    noises.push_back(noise_point(window.e, true));
  }
  plants_ = machine_of(plants);
  noises_ = machine_of(noises);
}

/// The window of this number, with e - X b_0 instead of e.
PlantAndNoise HealthyWindows::window_of(const PlantAndNoise& record, Eigen::Index number) const {
  const Eigen::Index first = number * rule_.step;
  const Eigen::MatrixXd X = record.X.middleRows(first, rule_.window);
  return {record.e.segment(first, rule_.window) - X * whole_.b, X};
}

Eigen::VectorXd HealthyWindows::plant_point(const PlantAndNoise& window, bool own) const {
  const PrewhitenedGroups groups = prewhitened_groups(window.e, {window.X});
  if (groups.rank == 0 || !(groups.variance > 0.0))
    return Eigen::VectorXd::Zero(window.X.cols());
  const Eigen::MatrixXd& X = groups.X[0];
  Eigen::MatrixXd information = X.transpose() * X / groups.variance;
  // An input that stands still in the window gets the deviation 0.
  information.diagonal() = information.diagonal().array() * (1.0 + kLeastInformation) + kLeastDiagonal;
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const Eigen::VectorXd b = factor.matrixL().solve(X.transpose() * groups.r / groups.variance);
  return own ? Eigen::VectorXd(b / own_deviation_)
             : standard_deviations(factor.matrixU(), whole_.covariance, b);
}

Eigen::VectorXd HealthyWindows::noise_point(const Eigen::VectorXd& v, bool own) const {
  const NoiseEstimate now = noise_estimate(v, kHighestNoiseOrder);
  const Eigen::MatrixXd R = now.information.llt().matrixU();
  const Eigen::VectorXd a = R * (now.a - noise_.a);
  const double ratio = std::log(now.variance / noise_.variance);
  Eigen::VectorXd point(a.size() + 1);
  if (own)
    point << a / own_deviation_, ratio / std::sqrt(2.0 / now.freedom) / own_deviation_;
  else
    point << standard_deviations(R, noise_covariance_, a),
        ratio / std::sqrt(2.0 / now.freedom + 2.0 / noise_.freedom);
  return point;
}

std::optional<OneClassSvm> HealthyWindows::machine_of(const std::vector<Eigen::VectorXd>& points) const {
  const auto n = static_cast<Eigen::Index>(points.size());
  const Eigen::Index m = points[0].size();
  if (m == 0)
    return {};
  Eigen::MatrixXd learnt(m, std::max(n, kMachinePoints));
  for (Eigen::Index k = 0; k < n; ++k)
    learnt.col(k) = points[static_cast<std::size_t>(k)];
  const Eigen::MatrixXd found = learnt.leftCols(n) * learnt.leftCols(n).transpose() / static_cast<double>(n);
  const auto weight = static_cast<double>(m);
  const double variance = std::max(1.0, found.trace() / weight);
  Eigen::MatrixXd covariance = independent_ * found;
  covariance.diagonal().array() += weight * variance;
  covariance /= independent_ + weight;
  const Eigen::MatrixXd L = covariance.llt().matrixL();
  RandomStream stream(kMachineSeed, 0, StreamId::bootstrap);
  for (Eigen::Index k = n; k < learnt.cols(); ++k) {
    Eigen::VectorXd drawn(m);
    for (double& value : drawn)
      value = stream.normal();
    learnt.col(k) = L * drawn;
  }
  return OneClassSvm(learnt, rule_.nu, 0.5 / covariance.trace());
}

HealthyWindows::Outside HealthyWindows::outside_window(const PlantAndNoise& window) const {
  Outside result{-kInfinity, -kInfinity};
  if (plants_)
    result.plant = plants_->outsideness(plant_point(window, false));
  Eigen::VectorXd v = window.e;
  if (result.plant > 0.0) {
    const Eigen::VectorXd explained = window.X * refined_groups(window.e, {window.X}).coefficients();
    v -= explained;
    if (sample_variance(v) < kLeastNoiseShare * sample_variance(explained))
      return result;
  }
  if (noises_ && sample_variance(v) > 0.0)
    result.noise = noises_->outsideness(noise_point(v, false));
  return result;
}

HealthyWindows::Outside HealthyWindows::outside(const PlantAndNoise& record) const {
  const Eigen::Index n = rule_.windows(record.e.size());
  if (n == 0)
    throw InputError("samples of a record", fmt::format("{}", record.e.size()),
                     fmt::format("a window of {} or more", rule_.window));
  std::vector<double> plants, noises;
  for (Eigen::Index number = 0; number < n; ++number) {
    const Outside of = outside_window(window_of(record, number));
    plants.push_back(of.plant);
    noises.push_back(of.noise);
  }
  return {exceeded_by_share(std::move(plants), rule_.share),
          exceeded_by_share(std::move(noises), rule_.share)};
}

}  // namespace mpm
