#include "analysis/identification/decorrelation.hpp"

#include <cmath>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

Eigen::MatrixXd about_means(const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  return signals.colwise() - signals.rowwise().mean();
}

/// Returns Q such that Q Q'x = A b, where b minimises |x - A b|^2 + r^2 |b|^2 with r = kRankTolerance |A|. Q
/// is the upper rows of the orthogonal factor of (A; r I), so that no singular value is squared.
Eigen::MatrixXd ridge_basis(const Eigen::MatrixXd& A) {
  const Eigen::Index rows = A.rows(), n = A.cols();
  Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(rows + n, n);
  augmented.topRows(rows) = A;
  augmented.bottomRows(n).diagonal().setConstant(kRankTolerance * A.norm());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(augmented);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(rows + n, n);
  return Q.topRows(rows);
}

Eigen::MatrixXd regressors(const Eigen::MatrixXd& inputs, const DecorrelationOptions& options) {
  Eigen::MatrixXd columns(inputs.cols(), inputs.rows() * options.fir_length + 1);
  columns << Eigen::VectorXd::Ones(inputs.cols()),
      laguerre_responses(inputs, options.fir_length, options.fir_pole);
  // Columns of unit norm: the residuals must not depend on the units of the inputs.
  for (Eigen::Index column = 0; column < columns.cols(); ++column)
    if (const double norm = columns.col(column).norm(); norm > 0.0)
      columns.col(column) /= norm;
  return columns;
}

Eigen::Index coefficients(const Eigen::MatrixXd& inputs, const DecorrelationOptions& options) {
  return inputs.rows() *
         (options.model == DecorrelationModel::fir ? options.fir_length : options.nb + options.nf);
}

void require_finite(const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  if (!signals.allFinite())
    throw InputError("signals to be decorrelated", "a value that is not finite", "finite values only");
}

}  // namespace

void DecorrelationOptions::validate() const {
  if (nb < 1 || nf < 0)
    throw InputError("orders nb and nf of a decorrelation", fmt::format("{} and {}", nb, nf),
                     "nb 1 or more, nf 0 or more");
  if (fir_length < 1)
    throw InputError("length of the regression of a decorrelation", fmt::format("{}", fir_length),
                     "1 or more");
  if (!(fir_pole >= 0.0 && fir_pole < 1.0))
    throw InputError("pole of the regression of a decorrelation", fmt::format("{}", fir_pole),
                     "0 or more, below 1");
  search.validate();
}

Decorrelator::Decorrelator(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                           const DecorrelationOptions& options)
    : inputs_(inputs), options_(options) {
  options_.validate();
  require_finite(inputs_);
  if (inputs_.cols() <= coefficients(inputs_, options_) + 1)
    throw InputError("samples of a decorrelation", fmt::format("{}", inputs_.cols()),
                     fmt::format("more than its {} coefficients", coefficients(inputs_, options_) + 1));
  if (options_.model == DecorrelationModel::fir && inputs_.rows() > 0)
    basis_ = ridge_basis(regressors(inputs_, options_));
}

Decorrelation Decorrelator::decorrelate(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                        Eigen::Index delay) const {
  if (delay < 0)
    throw InputError("delay of a decorrelation", fmt::format("{} samples", delay), "0 or more");
  if (signals.cols() != inputs_.cols())
    throw InputError("samples of signals and inputs",
                     fmt::format("{} and {}", signals.cols(), inputs_.cols()), "the same number");
  require_finite(signals);
  Decorrelation result{about_means(signals), coefficients(inputs_, options_)};
  if (inputs_.rows() == 0 || signals.rows() == 0)
    return result;
  if (options_.model == DecorrelationModel::output_error)
    return search(std::move(result), delay);
  const Eigen::MatrixXd explained = result.residuals * basis_;
  result.residuals.noalias() -= explained * basis_.transpose();
  return result;
}

Decorrelation Decorrelator::search(Decorrelation result, Eigen::Index delay) const {
  const Eigen::MatrixXd u = about_means(inputs_);
  const ModelOrder order = output_error_order(u.rows(), options_.nb, options_.nf, delay);
  for (Eigen::Index row = 0; row < result.residuals.rows(); ++row) {
    const Eigen::VectorXd x = result.residuals.row(row).transpose();
    const Identification found = identify_prediction_error(x, u, order, options_.search);
    result.unusable += is_usable(found.status) ? 0 : 1;
    const Eigen::VectorXd left = x - simulate(found.model, u, options_.search.start);
    result.residuals.row(row) = (left.array() - left.mean()).transpose();
  }
  return result;
}

Eigen::MatrixXd laguerre_responses(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index length,
                                   double pole) {
  const Eigen::Vector2d denominator(1.0, -pole);
  const Eigen::VectorXd first = Eigen::VectorXd::Constant(1, std::sqrt(1.0 - pole * pole));
  const Eigen::Vector2d all_pass(-pole, 1.0);
  Eigen::MatrixXd responses(inputs.cols(), inputs.rows() * length);
  for (Eigen::Index row = 0; row < inputs.rows(); ++row) {
    Eigen::VectorXd response = inputs.row(row).transpose();
    responses.col(row * length) = response;
    for (Eigen::Index i = 1; i < length; ++i) {
      response = i == 1 ? filter(first, denominator, response, 1, StartState::held)
                        : filter(all_pass, denominator, response, 0, StartState::held);
      responses.col(row * length + i) = response;
    }
  }
  return responses;
}

}  // namespace mpm
