#include "analysis/methods/literature/noise_model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/nested_least_squares.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {

Eigen::Index NoiseModel::order() const {
  return std::max(C.size(), D.size()) - 1;
}

NoiseModel integrated_noise(double c) {
  if (!(c >= 0.0 && c < 1.0))
    throw InputError("filter of integrated noise", fmt::format("{}", c), "0 or more and below 1");
  return {Eigen::Vector2d(1.0, -c), Eigen::Vector2d(1.0, -1.0)};
}

NoiseModel autoregressive_noise(const Eigen::Ref<const Eigen::VectorXd>& v, Eigen::Index highest_order) {
  if (highest_order < 0)
    throw InputError("order of an autoregression", fmt::format("{}", highest_order), "0 or more");
  require_signal("output error", v, std::max<Eigen::Index>(2, 3 * highest_order));
  const Eigen::Index n = v.size() - highest_order;
  Eigen::MatrixXd past(n, highest_order);
  for (Eigen::Index lag = 1; lag <= highest_order; ++lag)
    past.col(lag - 1) = v.segment(highest_order - lag, n);
  const NestedLeastSquares fit(past, v.tail(n), kRankTolerance);
  const auto samples = static_cast<double>(n);
  const auto bic = [&](Eigen::Index order) {
    return samples * std::log(fit.residual_sum(order, 0)) + std::log(samples) * static_cast<double>(order);
  };
  Eigen::Index best = 0;
  for (Eigen::Index order = 1; order <= highest_order; ++order)
    if (bic(order) < bic(best))
      best = order;
  NoiseModel model;
  model.D.resize(best + 1);
  model.D << 1.0, -fit.solution(best, 0);
  return model;
}

double innovation_variance(const Eigen::Ref<const Eigen::VectorXd>& v, Eigen::Index highest_order) {
  const Eigen::VectorXd about_mean = v.array() - v.mean();
  const NoiseModel model = autoregressive_noise(about_mean, highest_order);
  const Eigen::Index n = v.size() - highest_order;
  return filter(model.D, model.C, about_mean).tail(n).squaredNorm() /
         static_cast<double>(n - model.order() - 1);
}

Eigen::VectorXd one_step_errors(const NoiseModel& model, const Eigen::Ref<const Eigen::VectorXd>& y,
                                const Eigen::Ref<const Eigen::VectorXd>& y_sim) {
  require_same_length("y", y, "y_sim", y_sim);
  return filter(model.D, model.C, y_sim - y);
}

}  // namespace mpm
