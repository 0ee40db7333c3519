#include "scenarios/faults/tuning.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

Eigen::VectorXd MpcOptions::*weights_of(TuningParameter parameter) {
  switch (parameter) {
    case TuningParameter::move_suppression:
      return &MpcOptions::move_suppression;
    case TuningParameter::target_weight:
      return &MpcOptions::target_weight;
    case TuningParameter::slack_weight:
      return &MpcOptions::slack_weight;
    case TuningParameter::setpoint_weight:
      return &MpcOptions::setpoint_weight;
  }
  return &MpcOptions::move_suppression;
}

/// A slack weight has no effect on a CV without a soft limit.
bool has_weight(const MpcOptions& controller, TuningParameter parameter, Eigen::Index i) {
  return (controller.*weights_of(parameter))(i) > 0.0 &&
         (parameter != TuningParameter::slack_weight || controller.has_soft_limit(i));
}

}  // namespace

bool is_of_mv(TuningParameter parameter) {
  return parameter == TuningParameter::move_suppression || parameter == TuningParameter::target_weight;
}

std::vector<Eigen::Index> variables_with(const MpcOptions& controller, TuningParameter parameter) {
  std::vector<Eigen::Index> variables;
  for (Eigen::Index i = 0; i < (controller.*weights_of(parameter)).size(); ++i)
    if (has_weight(controller, parameter, i))
      variables.push_back(i);
  return variables;
}

MpcOptions with_tuning(MpcOptions controller, const TuningChange& change) {
  Eigen::VectorXd& weights = controller.*weights_of(change.parameter);
  if (change.index < 0 || change.index >= weights.size() ||
      !has_weight(controller, change.parameter, change.index))
    throw InputError(fmt::format("tuning: {}", to_string(change.parameter)),
                     fmt::format("{} number {}", is_of_mv(change.parameter) ? "MV" : "CV", change.index),
                     "a variable that has this weight");
  if (!(std::isfinite(change.factor) && change.factor > 0.0))
    throw InputError("tuning: factor", fmt::format("{}", change.factor), "a number > 0");
  weights(change.index) *= change.factor;
  return controller;
}

std::array<double, 4> TuningRanges::weights_for(const MpcOptions& controller) const {
  std::array<double, 4> weights = parameter_weight;
  for (std::size_t p = 0; p < weights.size(); ++p)
    if (variables_with(controller, kTuningParameters[p]).empty())
      weights[p] = 0.0;
  return weights;
}

}  // namespace mpm
