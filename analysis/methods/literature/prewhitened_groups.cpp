#include "analysis/methods/literature/prewhitened_groups.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/statistics/discrete_filter.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The fewest degrees of freedom that must remain.
constexpr Eigen::Index kFewestFreedom = 20;
/// A direction of a group counts if this share of its length remains after the past of e is projected out.
constexpr double kOwnShare = 1e-6;
/// Iterations of the noise model with the groups; the last one changes the coefficients only a little.
constexpr int kTurns = 3;

using Matrices = std::vector<Eigen::MatrixXd>;

/// Orthonormal columns that span the columns of X, which are first scaled to unit norm.
Eigen::MatrixXd orthonormal_columns(Eigen::MatrixXd X) {
  if (X.cols() == 0)
    return X;
  for (Eigen::Index column = 0; column < X.cols(); ++column)
    if (const double norm = X.col(column).norm(); norm > 0.0)
      X.col(column) /= norm;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(X.rows(), X.cols());
  qr.setThreshold(kOwnShare);
  qr.compute(X);
  return qr.householderQ() * Eigen::MatrixXd::Identity(X.rows(), qr.rank());
}

Eigen::MatrixXd joined_groups(const Matrices& matrices, Eigen::Index rows, std::size_t but_for) {
  Eigen::Index columns = 0;
  for (std::size_t j = 0; j < matrices.size(); ++j)
    columns += j == but_for ? 0 : matrices[j].cols();
  Eigen::MatrixXd all(rows, columns);
  columns = 0;
  for (std::size_t j = 0; j < matrices.size(); ++j) {
    if (j == but_for)
      continue;
    all.middleCols(columns, matrices[j].cols()) = matrices[j];
    columns += matrices[j].cols();
  }
  return all;
}

constexpr auto kAll = static_cast<std::size_t>(-1);

/// A constant and the last p samples of v, for the samples after the first kHighestNoiseOrder ones.
Eigen::MatrixXd constant_and_past(const Eigen::VectorXd& v, Eigen::Index p) {
  const Eigen::Index n = v.size() - kHighestNoiseOrder;
  Eigen::MatrixXd past(n, p + 1);
  past.col(0).setOnes();
  for (Eigen::Index lag = 1; lag <= p; ++lag)
    past.col(lag) = v.segment(kHighestNoiseOrder - lag, n);
  return past;
}

/// A X, column by column. The first kHighestNoiseOrder samples, in which the filter forgets its start, are
/// cut.
Eigen::MatrixXd prewhitened_columns(const NoiseModel& noise, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd result(X.rows() - kHighestNoiseOrder, X.cols());
  for (Eigen::Index column = 0; column < X.cols(); ++column)
    result.col(column) = filter(noise.D, noise.C, X.col(column)).tail(result.rows());
  return result;
}

void require_regressors(const Eigen::Ref<const Eigen::VectorXd>& e, const Matrices& groups) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& X : groups) {
    if (X.rows() != e.size() || !X.allFinite())
      throw InputError("regressors of a simulation error", "other samples than it has, or not finite ones",
                       fmt::format("{} finite samples", e.size()));
    columns += X.cols();
  }
  require_signal("simulation error", e, fewest_prewhitened_samples(columns));
}

NoiseModel noise_model_of(const Eigen::VectorXd& v) {
  return autoregressive_noise((v.array() - v.mean()).matrix(), kHighestNoiseOrder);
}

/// The regression about this v.
PrewhitenedGroups groups_about(const Eigen::VectorXd& v, const Eigen::Ref<const Eigen::VectorXd>& e,
                               const Matrices& groups) {
  PrewhitenedGroups result;
  result.noise = noise_model_of(v);
  const Eigen::MatrixXd past = orthonormal_columns(constant_and_past(v, result.noise.order()));
  const auto without_past = [&past](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
    return x - past * (past.transpose() * x);
  };
  result.r = without_past(prewhitened_columns(result.noise, e));
  for (const Eigen::MatrixXd& X : groups) {
    const Eigen::MatrixXd filtered = prewhitened_columns(result.noise, X);
    Eigen::MatrixXd own = without_past(filtered);
    // If the past explains a column, its rest is only rounding and not a regressor.
    for (Eigen::Index column = 0; column < own.cols(); ++column)
      if (!(own.col(column).norm() > kOwnShare * filtered.col(column).norm()))
        own.col(column).setZero();
    result.Q.push_back(orthonormal_columns(own));
    result.X.push_back(std::move(own));
  }
  const Eigen::MatrixXd all = orthonormal_columns(joined_groups(result.Q, past.rows(), kAll));
  result.rank = all.cols();
  result.freedom = past.rows() - past.cols() - result.rank;
  const double left = result.r.squaredNorm() - (all.transpose() * result.r).squaredNorm();
  const double rounding = static_cast<double>(past.rows()) * variance_floor(e);
  result.variance = left > rounding ? left / static_cast<double>(result.freedom) : 0.0;
  return result;
}

}  // namespace

Eigen::Index fewest_prewhitened_samples(Eigen::Index columns) {
  return 2 * kHighestNoiseOrder + 1 + columns + kFewestFreedom;
}

double PrewhitenedGroups::ratio(std::size_t group) const {
  const Eigen::MatrixXd& q = Q[group];
  return q.cols() == 0 || !(variance > 0.0)
             ? 0.0
             : (q.transpose() * r).squaredNorm() / (static_cast<double>(q.cols()) * variance);
}

double PrewhitenedGroups::partial_ratio(std::size_t group) const {
  const auto columns = static_cast<double>(Q[group].cols());
  if (columns == 0.0 || !(variance > 0.0))
    return 0.0;
  const Eigen::MatrixXd others = orthonormal_columns(joined_groups(Q, r.size(), group));
  const double without = r.squaredNorm() - (others.transpose() * r).squaredNorm();
  return std::max(0.0, without - static_cast<double>(freedom) * variance) / (columns * variance);
}

double PrewhitenedGroups::critical_ratio(std::size_t group, double probability) const {
  return critical_ratio_of(Q[group].cols(), probability);
}

double PrewhitenedGroups::joint_ratio() const {
  if (rank == 0 || !(variance > 0.0))
    return 0.0;
  const double explained = r.squaredNorm() - static_cast<double>(freedom) * variance;
  return explained / (static_cast<double>(rank) * variance);
}

double PrewhitenedGroups::critical_ratio_of(Eigen::Index columns, double probability) const {
  if (columns == 0)
    return kInfinity;
  return f_upper_quantile(probability, static_cast<double>(columns), static_cast<double>(freedom));
}

Eigen::VectorXd PrewhitenedGroups::coefficients() const {
  return joined_groups(X, r.size(), kAll).completeOrthogonalDecomposition().solve(r);
}

PrewhitenedGroups prewhitened_groups(const Eigen::Ref<const Eigen::VectorXd>& e, const Matrices& groups) {
  require_regressors(e, groups);
  return groups_about(e, e, groups);
}

PrewhitenedGroups refined_groups(const Eigen::Ref<const Eigen::VectorXd>& e, const Matrices& groups) {
  require_regressors(e, groups);
  const Eigen::MatrixXd X = joined_groups(groups, e.size(), kAll);
  if (X.cols() == 0)
    return groups_about(e, e, groups);
  const Eigen::MatrixXd centred = X.rowwise() - X.colwise().mean();
  Eigen::VectorXd b =
      centred.completeOrthogonalDecomposition().solve(Eigen::VectorXd((e.array() - e.mean()).matrix()));
  PrewhitenedGroups found;
  for (int turn = 0; turn < kTurns; ++turn) {
    found = groups_about(e - X * b, e, groups);
    b = found.coefficients();
  }
  return found;
}

}  // namespace mpm
