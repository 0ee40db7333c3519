#include "analysis/identification/noise_filter.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/discrete_filter.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {

Eigen::MatrixXd noise_filtered(const Eigen::Ref<const Eigen::MatrixXd>& signals, NoiseFilter filter,
                               Eigen::Index length) {
  if (length < 1)
    throw InputError("length of a noise filter", fmt::format("{} samples", length), "1 or more");
  for (Eigen::Index row = 0; row < signals.rows(); ++row)
    require_signal(fmt::format("signal {} of a noise filter", row), signals.row(row).transpose(), 1);
  if (filter != NoiseFilter::moving_average && filter != NoiseFilter::first_order)
    return signals;
  const auto n = static_cast<double>(length);
  Eigen::VectorXd numerator = Eigen::VectorXd::Constant(length, 1.0 / n);
  Eigen::VectorXd denominator = Eigen::VectorXd::Ones(1);
  if (filter == NoiseFilter::first_order) {
    const double a = std::exp(-1.0 / n);
    numerator = Eigen::VectorXd::Constant(1, 1.0 - a);
    denominator = Eigen::Vector2d(1.0, -a);
  }
  Eigen::MatrixXd filtered(signals.rows(), signals.cols());
  for (Eigen::Index row = 0; row < signals.rows(); ++row)
    filtered.row(row) =
        mpm::filter(numerator, denominator, signals.row(row).transpose(), 0, StartState::held).transpose();
  return filtered;
}

Eigen::MatrixXd moving_rows(const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  Eigen::MatrixXd moving(signals.rows(), signals.cols());
  Eigen::Index rows = 0;
  for (Eigen::Index row = 0; row < signals.rows(); ++row)
    if (!stands_still(signals.row(row).transpose()))
      moving.row(rows++) = signals.row(row);
  return moving.topRows(rows);
}

Eigen::MatrixXd externally_driven(const Eigen::Ref<const Eigen::MatrixXd>& u,
                                  const Eigen::Ref<const Eigen::MatrixXd>& external,
                                  const DecorrelationOptions& options) {
  const Eigen::MatrixXd moving = moving_rows(external);
  if (moving.rows() == 0)
    return u.rowwise().mean().replicate(1, u.cols());
  return u - Decorrelator(moving, options).decorrelate(u, 0).residuals;
}

}  // namespace mpm
