#include "analysis/methods/literature/model_comparison.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

double plant_distance(const PrewhitenedGroups& groups, const HealthyModel& before, double probability) {
  if (groups.rank == 0)
    return 0.0;
  const Eigen::MatrixXd& Q = groups.Q[0];
  const Eigen::VectorXd s = Q.transpose() * groups.r;
  const Eigen::MatrixXd M = Q.transpose() * groups.X[0];
  Eigen::MatrixXd covariance = M * before.covariance * M.transpose();
  covariance.diagonal().array() += groups.variance;
  const double distance = s.dot(covariance.ldlt().solve(s)) / static_cast<double>(groups.rank);
  return distance / groups.critical_ratio_of(groups.rank, probability);
}

/// Uses (C + C_0)^-1 = P (P + P_0)^-1 P_0 with P = C^-1.
double noise_distance(const Eigen::VectorXd& v, const Eigen::VectorXd& v_before, double probability) {
  constexpr auto p = kHighestNoiseOrder;
  const NoiseEstimate now = noise_estimate(v, p), before = noise_estimate(v_before, p);
  const Eigen::VectorXd difference = now.a - before.a;
  const Eigen::VectorXd weighted =
      now.information * (now.information + before.information).ldlt().solve(before.information * difference);
  return difference.dot(weighted) / static_cast<double>(p) /
         f_upper_quantile(probability, static_cast<double>(p), std::min(now.freedom, before.freedom));
}

}  // namespace

double sample_variance(const Eigen::VectorXd& x) {
  return (x.array() - x.mean()).matrix().squaredNorm() / static_cast<double>(x.size());
}

NoiseEstimate noise_estimate(const Eigen::VectorXd& v, Eigen::Index p) {
  const Eigen::Index n = v.size() - p;
  Eigen::MatrixXd past(n, p);
  for (Eigen::Index lag = 1; lag <= p; ++lag)
    past.col(lag - 1) = v.segment(p - lag, n);
  const Eigen::MatrixXd centred = past.rowwise() - past.colwise().mean();
  const Eigen::VectorXd now = v.tail(n).array() - v.tail(n).mean();
  NoiseEstimate found;
  found.a = centred.colPivHouseholderQr().solve(now);
  found.freedom = static_cast<double>(n - p - 1);
  found.variance = (now - centred * found.a).squaredNorm() / found.freedom;
  found.information = centred.transpose() * centred / found.variance;
  return found;
}

HealthyModel healthy_model(const PlantAndNoise& period) {
  const PrewhitenedGroups groups = refined_groups(period.e, {period.X});
  const Eigen::Index m = period.X.cols();
  HealthyModel model;
  model.b = m == 0 ? Eigen::VectorXd(0) : groups.coefficients();
  model.v = m == 0 ? Eigen::VectorXd(period.e) : Eigen::VectorXd(period.e - period.X * model.b);
  model.variance = groups.variance;
  model.freedom = groups.freedom;
  model.covariance = Eigen::MatrixXd::Zero(m, m);
  if (groups.rank > 0 && groups.variance > 0.0) {
    Eigen::MatrixXd information = groups.X[0].transpose() * groups.X[0];
    information.diagonal().array() += kLeastInformation * information.diagonal().maxCoeff();
    model.covariance = groups.variance * information.ldlt().solve(Eigen::MatrixXd::Identity(m, m));
  }
  return model;
}

ModelComparison compare_models(const PlantAndNoise& now, const HealthyModel& before, double probability) {
  if (now.X.cols() != before.b.size())
    throw InputError("regressors of two periods", fmt::format("{} and {}", now.X.cols(), before.b.size()),
                     "the same number");
  const Eigen::VectorXd as_before = now.X.cols() == 0 ? now.e : Eigen::VectorXd(now.e - now.X * before.b);
  PrewhitenedGroups groups = prewhitened_groups(as_before, {now.X});
  if (!(groups.variance > 0.0 && before.variance > 0.0))
    return {};
  ModelComparison result;
  result.plant = plant_distance(groups, before, probability);
  Eigen::VectorXd v = as_before;
  if (result.plant > 1.0) {
    groups = refined_groups(now.e, {now.X});
    const Eigen::VectorXd explained = now.X * groups.coefficients();
    v = now.e - explained;
    if (sample_variance(v) < kLeastNoiseShare * sample_variance(explained))
      return result;
  }
  result.noise_model = noise_distance(v, before.v, probability);
  const auto f = static_cast<double>(groups.freedom), f_before = static_cast<double>(before.freedom);
  const double ratio = groups.variance / before.variance;
  result.noise_variance = std::max(ratio / f_upper_quantile(0.5 * probability, f, f_before),
                                   1.0 / ratio / f_upper_quantile(0.5 * probability, f_before, f));
  return result;
}

}  // namespace mpm
