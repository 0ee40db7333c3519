#include "analysis/methods/literature/variability_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "analysis/methods/literature/subspace_angle.hpp"
#include "analysis/methods/literature/variance_ratio_limits.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// The smallest eigenvalue of a covariance matrix that counts as above 0, as a share of its entries. The
/// entries carry rounding errors of about 1e-16 times the square root of the length: 1e-14 for the longest
/// records.
constexpr double kSmallestEigenvalue = 1e-13;

void require_errors(const char* name, const Eigen::Ref<const Eigen::MatrixXd>& errors) {
  if (errors.rows() < 1 || errors.cols() < 2)
    throw InputError(fmt::format("control errors of the {} period", name),
                     fmt::format("{} CVs x {} samples", errors.rows(), errors.cols()),
                     "1 CV and 2 samples, or more");
  for (Eigen::Index i = 0; i < errors.rows(); ++i)
    require_signal(fmt::format("control errors of the {} period, CV {}", name, i), errors.row(i).transpose(),
                   2);
}

Eigen::MatrixXd covariance(const Eigen::Ref<const Eigen::MatrixXd>& errors) {
  const Eigen::MatrixXd centred = errors.colwise() - errors.rowwise().mean();
  return centred * centred.transpose() / static_cast<double>(errors.cols() - 1);
}

/// Standard deviation of each CV; 0 for a CV that stands still up to rounding.
Eigen::VectorXd deviations(const Eigen::Ref<const Eigen::MatrixXd>& errors,
                           const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd result = covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    const Eigen::VectorXd error = errors.row(i).transpose();
    if (stands_still(error) || covariance(i, i) <= variance_floor(error))
      result(i) = 0.0;
  }
  return result;
}

/// Are the CVs, each in units of its standard deviation, linearly dependent?
bool is_singular(const Eigen::MatrixXd& correlation) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  return !(solver.eigenvalues()(0) > kSmallestEigenvalue);
}

VariabilityChange change_of(const Interval& limits) {
  if (limits.lower > 1.0)
    return VariabilityChange::worse;
  return limits.upper < 1.0 ? VariabilityChange::better : VariabilityChange::none;
}

/// The direction p with unit length and its largest entry above 0, since an eigenvector has no sign of its
/// own.
Eigen::VectorXd with_unit_length(const Eigen::VectorXd& p) {
  Eigen::Index largest = 0;
  p.cwiseAbs().maxCoeff(&largest);
  return p / std::copysign(p.norm(), p(largest));
}

/// The direction p with ratio mu, judged by the errors along it.
VariabilityDirection judge_direction(double mu, const Eigen::VectorXd& p,
                                     const Eigen::Ref<const Eigen::MatrixXd>& benchmark,
                                     const Eigen::Ref<const Eigen::MatrixXd>& monitored,
                                     const VariabilityOptions& options) {
  VariabilityDirection direction;
  direction.mu = mu;
  direction.p = with_unit_length(p);
  direction.f_benchmark = autocorrelation_factor(benchmark.transpose() * direction.p, options.largest_lag);
  // If nothing moves, only rounding errors would be correlated.
  direction.f_monitored =
      mu > 0.0 ? autocorrelation_factor(monitored.transpose() * direction.p, options.largest_lag) : 1.0;
  const VarianceSample of_benchmark{benchmark.cols(), direction.f_benchmark};
  const VarianceSample of_monitored{monitored.cols(), direction.f_monitored};
  direction.limits = options.limits == VariabilityLimits::published
                         ? variance_ratio_limits(direction.mu, of_benchmark, of_monitored, options.confidence)
                         : largest_root_limits(direction.mu, of_benchmark, of_monitored, options.confidence,
                                               benchmark.rows());
  direction.change = change_of(direction.limits);
  return direction;
}

Eigen::VectorXd cosines(const std::vector<VariabilityDirection>& directions, VariabilityChange change,
                        Eigen::Index ny) {
  Eigen::MatrixXd columns(ny, 0);
  for (const VariabilityDirection& direction : directions)
    if (direction.change == change) {
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.rightCols(1) = direction.p;
    }
  return subspace_cosines(columns);
}

}  // namespace

void VariabilityOptions::validate() const {
  require_confidence(confidence);
  if (largest_lag < 0)
    throw InputError("largest_lag", fmt::format("{}", largest_lag), "0 (all lags) or more");
}

VariabilityComparison compare_variability(const Eigen::Ref<const Eigen::MatrixXd>& benchmark,
                                          const Eigen::Ref<const Eigen::MatrixXd>& monitored,
                                          const VariabilityOptions& options) {
  options.validate();
  require_errors("benchmark", benchmark);
  require_errors("monitored", monitored);
  const Eigen::Index ny = benchmark.rows();
  if (monitored.rows() != ny)
    throw InputError("CVs of the monitored period", fmt::format("{}", monitored.rows()),
                     fmt::format("{}, as in the benchmark period", ny));

  VariabilityComparison result;
  result.status = VariabilityStatus::singular_benchmark;
  const Eigen::MatrixXd covariance_benchmark = covariance(benchmark);
  const Eigen::VectorXd deviation = deviations(benchmark, covariance_benchmark);
  if (deviation.minCoeff() == 0.0)
    return result;
  // In units of the benchmark's deviations, so that the units of the CVs do not hide a dependence.
  const Eigen::MatrixXd to_unit = deviation.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd correlation = to_unit * covariance_benchmark * to_unit;
  if (is_singular(correlation))
    return result;
  const Eigen::MatrixXd scaled = to_unit * covariance(monitored) * to_unit;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, correlation);

  const double smallest = kSmallestEigenvalue * std::max(1.0, solver.eigenvalues()(ny - 1));

  result.status = VariabilityStatus::ok;
  result.i_v = 1.0;
  for (Eigen::Index i = ny - 1; i >= 0; --i) {
    const double mu = solver.eigenvalues()(i) > smallest ? solver.eigenvalues()(i) : 0.0;
    const Eigen::VectorXd p = to_unit * solver.eigenvectors().col(i);
    result.directions.push_back(judge_direction(mu, p, benchmark, monitored, options));
    result.i_v *= result.directions.back().mu;
  }
  result.cos_worse = cosines(result.directions, VariabilityChange::worse, ny);
  result.cos_better = cosines(result.directions, VariabilityChange::better, ny);
  result.beta = subspace_cosine_limit(benchmark.cols(), monitored.cols(), options.confidence);
  return result;
}

}  // namespace mpm
