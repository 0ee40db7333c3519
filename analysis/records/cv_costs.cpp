#include "analysis/records/cv_costs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/non_finite.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// E max(0, x)^2 of x ~ N(mean, deviation^2).
double mean_square_above_zero(double mean, double deviation) {
  if (!(deviation > 0.0))
    return std::pow(std::max(0.0, mean), 2);
  const double z = mean / deviation;
  const double tail = 0.5 * std::erfc(-z / std::numbers::sqrt2);
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  return deviation * deviation * ((1.0 + z * z) * tail + z * density);
}

/// E dist(x)^2 of x ~ N(y, deviation^2).
double mean_square_outside(double y, double lower, double upper, double deviation) {
  double sum = 0.0;
  if (std::isfinite(upper))
    sum += mean_square_above_zero(y - upper, deviation);
  if (std::isfinite(lower))
    sum += mean_square_above_zero(lower - y, deviation);
  return sum;
}

}  // namespace

std::vector<CvCost> cv_costs(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                             const Eigen::Ref<const Eigen::MatrixXd>& y0,
                             const Eigen::Ref<const Eigen::VectorXd>& noise, Eigen::Index from) {
  const MpcOptions& controller = study.controller;
  const Eigen::Index ny = y.rows(), N = std::min(y.cols(), y0.cols());
  const Eigen::MatrixXd y_set = setpoints(study);
  std::vector<CvCost> costs(static_cast<std::size_t>(ny));
  Eigen::VectorXd samples = Eigen::VectorXd::Zero(ny);
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    costs[static_cast<std::size_t>(cv)].cv = cv;
    costs[static_cast<std::size_t>(cv)].has_setpoint = controller.has_setpoint(cv);
  }
  for (Eigen::Index k = from; k < N; ++k) {
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      CvCost& cost = costs[static_cast<std::size_t>(cv)];
      if (std::isnan(y(cv, k)) || is_off(study, VariableSort::cv, cv, k))
        continue;
      if (cost.has_setpoint) {
        cost.now += std::pow(y(cv, k) - y_set(cv, k), 2);
        cost.designed += std::pow(y0(cv, k) - y_set(cv, k), 2) + noise(cv);
      } else if (controller.has_soft_limit(cv)) {
        cost.now += mean_square_outside(y(cv, k), soft.lower(cv), soft.upper(cv), 0.0);
        cost.designed += mean_square_outside(y0(cv, k), soft.lower(cv), soft.upper(cv), std::sqrt(noise(cv)));
      } else {
        continue;
      }
      samples(cv) += 1.0;
    }
  }
  for (CvCost& cost : costs) {
    const double n = samples(cost.cv);
    cost.now = n > 0.0 ? cost.now / n : kNaN;
    cost.designed = n > 0.0 ? cost.designed / n : kNaN;
    const double added = cost.has_setpoint ? 0.0 : noise(cost.cv);
    cost.ratio = (cost.now + added) / (cost.designed + added);
  }
  return costs;
}

}  // namespace mpm
