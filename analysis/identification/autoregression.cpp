#include "analysis/identification/autoregression.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/nested_least_squares.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "analysis/statistics/sample_spacing.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// Columns 1, e(k-s), ..., e(k-order s) at the rows.
Eigen::MatrixXd lagged_columns(const Eigen::Ref<const Eigen::VectorXd>& e,
                               const std::vector<Eigen::Index>& rows, Eigen::Index order,
                               Eigen::Index spacing) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(rows.size()), order + 1);
  columns.col(0).setOnes();
  for (Eigen::Index lag = 1; lag <= order; ++lag)
    for (Eigen::Index row = 0; row < columns.rows(); ++row)
      columns(row, lag) = e(rows[static_cast<std::size_t>(row)] - lag * spacing);
  return columns;
}

void require_autoregression_order(Eigen::Index order) {
  if (order < 0)
    throw InputError("order of an autoregression", fmt::format("{}", order), "0 or more");
}

}  // namespace

Eigen::MatrixXd Autoregression::whitened(const Eigen::Ref<const Eigen::MatrixXd>& x) const {
  Eigen::MatrixXd white(static_cast<Eigen::Index>(rows.size()), x.cols());
  for (Eigen::Index row = 0; row < white.rows(); ++row) {
    const Eigen::Index k = rows[static_cast<std::size_t>(row)];
    white.row(row) = x.row(k);
    for (Eigen::Index lag = 1; lag <= order(); ++lag)
      white.row(row) -= theta(lag) * x.row(k - lag * spacing);
  }
  return white;
}

std::vector<Eigen::Index> known_rows(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order) {
  const Eigen::Index spacing = sample_spacing(e);
  std::vector<Eigen::Index> rows, known(static_cast<std::size_t>(e.size()), 0);  // without a gap up to here
  for (Eigen::Index k = 0; k < e.size(); ++k) {
    if (std::isnan(e(k)))
      continue;
    const auto place = static_cast<std::size_t>(k);
    known[place] = 1 + (k < spacing ? 0 : known[static_cast<std::size_t>(k - spacing)]);
    if (known[place] > order)
      rows.push_back(k);
  }
  return rows;
}

Eigen::Index autoregression_order(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index largest_order) {
  require_autoregression_order(largest_order);
  const std::vector<Eigen::Index> rows = known_rows(e, largest_order);
  if (static_cast<Eigen::Index>(rows.size()) < 3 * (largest_order + 1))
    return 0;
  const NestedLeastSquares fit(lagged_columns(e, rows, largest_order, sample_spacing(e)), e(rows),
                               kRankTolerance);
  const auto n = static_cast<double>(rows.size());
  Eigen::Index best = 0;
  double least = n * std::log(fit.residual_sum(1, 0));
  for (Eigen::Index order = 1; order <= largest_order; ++order) {
    const double bic = n * std::log(fit.residual_sum(order + 1, 0)) +
                       static_cast<double>(fit.rank(order + 1) - 1) * std::log(n);
    if (bic < least) {
      least = bic;
      best = order;
    }
  }
  return best;
}

Autoregression fit_autoregression(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order) {
  require_autoregression_order(order);
  Autoregression model;
  model.rows = known_rows(e, order);
  model.spacing = sample_spacing(e);
  const auto n = static_cast<Eigen::Index>(model.rows.size());
  if (n <= order + 1)
    throw InputError("samples of an autoregression", fmt::format("{}", n),
                     fmt::format("more than {}, its coefficients", order + 1));
  const LeastSquares fit = least_squares(lagged_columns(e, model.rows, order, model.spacing), e(model.rows));
  model.theta = fit.x;
  model.covariance = Eigen::MatrixXd::Zero(order + 1, order + 1);
  if (fit.inverse.size() > 0)
    model.covariance = fit.residual_sum / static_cast<double>(model.freedom()) * fit.inverse;
  return model;
}

double log_p_same_autoregression(const Autoregression& one, const Autoregression& other) {
  if (one.order() != other.order())
    throw InputError("orders of two autoregressions", fmt::format("{} and {}", one.order(), other.order()),
                     "equal orders");
  const Eigen::VectorXd difference = one.theta - other.theta;
  const Eigen::LDLT<Eigen::MatrixXd> covariance(one.covariance + other.covariance);
  if (!(covariance.vectorD().minCoeff() > 0.0))
    return 0.0;
  const auto coefficients = static_cast<double>(difference.size());
  const double squared = difference.dot(covariance.solve(difference));
  return log_f_tail(std::max(0.0, squared) / coefficients, coefficients,
                    static_cast<double>(std::min(one.freedom(), other.freedom())));
}

}  // namespace mpm
