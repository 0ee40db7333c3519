#include "analysis/identification/arx.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

void require_arx(const ModelOrder& order) {
  bool rational = order.nc > 0 || order.nd > 0;
  for (const PathOrder& path : order.inputs)
    rational = rational || path.nf > 0;
  if (rational)
    throw InputError("orders of an ARX model", order.to_string(), "nf, nc and nd 0");
}

}  // namespace

void ArxOptions::validate(const ModelOrder& order) const {
  if (!(rank_tolerance > 0.0 && rank_tolerance < 1.0))
    throw InputError("rank tolerance", fmt::format("{}", rank_tolerance), "above 0 and below 1");
  if (first_sample && *first_sample < order.memory())
    throw InputError("first sample of an ARX regression", fmt::format("{}", *first_sample),
                     fmt::format("{} or later", order.memory()));
}

Eigen::MatrixXd arx_regressors(const ModelOrder& order, const Eigen::Ref<const Eigen::VectorXd>& y,
                               const Eigen::Ref<const Eigen::MatrixXd>& u, Eigen::Index first) {
  const Eigen::Index n = y.size() - first;
  Eigen::MatrixXd regressors(n, order.parameter_count());
  Eigen::Index column = 0;
  for (Eigen::Index i = 1; i <= order.na; ++i)
    regressors.col(column++) = -y.segment(first - i, n);
  for (std::size_t j = 0; j < order.inputs.size(); ++j) {
    const PathOrder& path = order.inputs[j];
    for (Eigen::Index i = path.delay; i < path.delay + path.nb; ++i)
      regressors.col(column++) = u.row(static_cast<Eigen::Index>(j)).segment(first - i, n).transpose();
  }
  return regressors;
}

Identification identify_arx(const Eigen::Ref<const Eigen::VectorXd>& y,
                            const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                            const ArxOptions& options) {
  order.validate(u.rows());
  require_arx(order);
  options.validate(order);
  Identification result;
  result.first_sample = options.first_sample.value_or(order.memory());
  require_identification_data(y, u, order, result.first_sample);
  result.samples = y.size() - result.first_sample;

  const LeastSquares fit = least_squares(arx_regressors(order, y, u, result.first_sample),
                                         y.tail(result.samples), options.rank_tolerance);
  const Eigen::Index p = order.parameter_count();
  result.model = model_from_parameters(order, fit.x);
  result.model.noise_variance = fit.residual_sum / static_cast<double>(result.samples - p);
  result.loss = fit.residual_sum / static_cast<double>(result.samples);
  result.status = fit.rank == p ? IdentificationStatus::ok : IdentificationStatus::rank_deficient;
  if (fit.rank == p)
    result.covariance = result.model.noise_variance * fit.inverse;
  return result;
}

}  // namespace mpm
