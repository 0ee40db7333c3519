#include "analysis/methods/decorrelation.hpp"

#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

Eigen::MatrixXd about_means(const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  return signals.colwise() - signals.rowwise().mean();
}

void require_record(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                    const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index parameters) {
  if (signals.cols() != inputs.cols())
    throw InputError("samples of signals and inputs", fmt::format("{} and {}", signals.cols(), inputs.cols()),
                     "the same number");
  if (!signals.allFinite() || !inputs.allFinite())
    throw InputError("signals to be decorrelated", "a value that is not finite", "finite values only");
  if (signals.cols() <= parameters)
    throw InputError("samples of a decorrelation", fmt::format("{}", signals.cols()),
                     fmt::format("more than its {} coefficients", parameters));
}

/// What is left of the columns of x outside of the span of the columns of A.
Eigen::MatrixXd projected_out(const Eigen::MatrixXd& A, const Eigen::MatrixXd& x) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
  qr.setThreshold(kRankTolerance);
  qr.compute(A);
  Eigen::MatrixXd rotated = x;
  rotated.applyOnTheLeft(qr.householderQ().setLength(qr.nonzeroPivots()).adjoint());
  rotated.topRows(qr.rank()).setZero();
  rotated.applyOnTheLeft(qr.householderQ().setLength(qr.nonzeroPivots()));
  return rotated;
}

Eigen::MatrixXd regression_residuals(const Eigen::MatrixXd& signals,
                                     const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                     const DecorrelationOptions& options) {
  Eigen::MatrixXd regressors(inputs.cols(), inputs.rows() * options.fir_length + 1);
  regressors << Eigen::VectorXd::Ones(inputs.cols()),
      laguerre_responses(inputs, options.fir_length, options.fir_pole);
  // Columns of unit norm: the rank must not depend on the units of the inputs.
  for (Eigen::Index column = 0; column < regressors.cols(); ++column)
    if (const double norm = regressors.col(column).norm(); norm > 0.0)
      regressors.col(column) /= norm;
  return projected_out(regressors, signals.transpose()).transpose();
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

Decorrelation decorrelate(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                          const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index delay,
                          const DecorrelationOptions& options) {
  options.validate();
  if (delay < 0)
    throw InputError("delay of a decorrelation", fmt::format("{} samples", delay), "0 or more");
  const bool search = options.model == DecorrelationModel::output_error;
  Decorrelation result;
  result.parameters = inputs.rows() * (search ? options.nb + options.nf : options.fir_length);
  require_record(signals, inputs, result.parameters + 1);
  result.residuals = about_means(signals);
  if (inputs.rows() == 0 || signals.rows() == 0)
    return result;
  if (!search) {
    result.residuals = regression_residuals(result.residuals, inputs, options);
    return result;
  }
  const Eigen::MatrixXd u = about_means(inputs);
  const ModelOrder order = output_error_order(u.rows(), options.nb, options.nf, delay);
  for (Eigen::Index row = 0; row < signals.rows(); ++row) {
    const Eigen::VectorXd x = result.residuals.row(row).transpose();
    const Identification found = identify_prediction_error(x, u, order, options.search);
    result.unusable += is_usable(found.status) ? 0 : 1;
    const Eigen::VectorXd left = x - simulate(found.model, u, options.search.start);
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
