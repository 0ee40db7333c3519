#include "analysis/records/cost_of_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/indicators/loop_cost.hpp"
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

std::vector<CvCost> cost_of_record(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                   const Eigen::Ref<const Eigen::MatrixXd>& y0,
                                   const Eigen::Ref<const Eigen::VectorXd>& noise, Eigen::Index from) {
  const MpcOptions& controller = study.controller;
  const Eigen::Index ny = y.rows(), N = std::min(y.cols(), y0.cols());
  const Eigen::MatrixXd y_set = setpoints(study);
  Eigen::VectorXd designed = Eigen::VectorXd::Zero(ny), samples = designed;
  for (Eigen::Index k = from; k < N; ++k) {
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      const bool has_setpoint = costs_by_setpoint(study, cv, LevelCost::in_range);
      if (std::isnan(y(cv, k)) || is_off(study, VariableSort::cv, cv, k) ||
          !(has_setpoint || controller.has_soft_limit(cv)))
        continue;
      designed(cv) +=
          has_setpoint ? std::pow(y0(cv, k) - y_set(cv, k), 2) + noise(cv)
                       : mean_square_outside(y0(cv, k), soft.lower(cv), soft.upper(cv), std::sqrt(noise(cv)));
      samples(cv) += 1.0;
    }
  }
  const Eigen::VectorXd now = cv_costs(study, y.leftCols(N), y_set, from, LevelCost::in_range);
  std::vector<CvCost> costs;
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    CvCost& cost = costs.emplace_back(
        CvCost{.cv = cv, .has_setpoint = costs_by_setpoint(study, cv, LevelCost::in_range)});
    cost.now = samples(cv) > 0.0 ? now(cv) : kNaN;
    cost.designed = samples(cv) > 0.0 ? designed(cv) / samples(cv) : kNaN;
    const double floor = cost.has_setpoint ? 0.0 : noise(cv);
    cost.ratio = (cost.now + floor) / (cost.designed + floor);
  }
  return costs;
}

}  // namespace mpm
