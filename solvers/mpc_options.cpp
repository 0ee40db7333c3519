#include "solvers/mpc_options.hpp"

#include <cmath>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "plants/same_members.hpp"

namespace mpm {
namespace {

void require_weights(const char* name, const Eigen::VectorXd& weights, Eigen::Index size) {
  if (weights.size() != size)
    throw InputError(name, fmt::format("{} numbers", weights.size()), fmt::format("{}", size));
  for (Eigen::Index i = 0; i < size; ++i)
    if (!std::isfinite(weights(i)) || weights(i) < 0)
      throw InputError(fmt::format("{}[{}]", name, i), fmt::format("{}", weights(i)), "a number >= 0");
}

auto members(const Limits& limits) {
  const auto& [lower, upper] = limits;
  return std::tie(lower, upper);
}

auto members(const MpcOptions& options) {
  const auto& [sample_time, prediction_horizon, control_horizon, move_suppression, target_weight,
               setpoint_weight, slack_weight, weight_convention, slack_form, mv_hard, cv_hard, cv_soft,
               mv_cost, target_violation_cost] = options;
  return std::tie(sample_time, prediction_horizon, control_horizon, move_suppression, target_weight,
                  setpoint_weight, slack_weight, weight_convention, slack_form, mv_hard, cv_hard, cv_soft,
                  mv_cost, target_violation_cost);
}

}  // namespace

std::string_view to_string(WeightConvention convention) {
  return convention == WeightConvention::direct ? "direct" : "squared";
}

std::string_view to_string(SlackForm form) {
  return form == SlackForm::per_sample ? "per-sample" : "per-cv";
}

Limits Limits::none(Eigen::Index size) {
  return {Eigen::VectorXd::Constant(size, -kInfinity), Eigen::VectorXd::Constant(size, kInfinity)};
}

void Limits::validate(std::string_view what, Eigen::Index size) const {
  if (lower.size() != size || upper.size() != size)
    throw InputError(std::string(what),
                     fmt::format("{} lower and {} upper limits", lower.size(), upper.size()),
                     fmt::format("{} of each", size));
  for (Eigen::Index i = 0; i < size; ++i)
    if (!(lower(i) <= upper(i) && lower(i) < kInfinity && upper(i) > -kInfinity))  // also false for NaN
      throw InputError(fmt::format("{}[{}]", what, i), fmt::format("lower {}, upper {}", lower(i), upper(i)),
                       "lower <= upper, no NaN, an absent limit is -inf below and inf above");
}

bool MpcOptions::has_soft_limit(Eigen::Index cv) const {
  return std::isfinite(cv_soft.lower(cv)) || std::isfinite(cv_soft.upper(cv));
}

bool MpcOptions::has_soft_limits() const {
  return cv_soft.lower.array().isFinite().any() || cv_soft.upper.array().isFinite().any();
}

void MpcOptions::validate(Eigen::Index cv_count, Eigen::Index mv_count) const {
  if (!(std::isfinite(sample_time) && sample_time > 0))
    throw InputError("sample_time", fmt::format("{}", sample_time), "a number > 0");
  if (prediction_horizon < 1)
    throw InputError("prediction_horizon", fmt::format("{}", prediction_horizon), "a whole number >= 1");
  if (control_horizon < 1 || control_horizon > prediction_horizon)
    throw InputError("control_horizon", fmt::format("{}", control_horizon),
                     fmt::format("1 to prediction_horizon = {}", prediction_horizon));
  require_weights("move_suppression", move_suppression, mv_count);
  require_weights("target_weight", target_weight, mv_count);
  require_weights("setpoint_weight", setpoint_weight, cv_count);
  for (Eigen::Index i = 0; i < mv_count; ++i)
    if (move_suppression(i) + target_weight(i) == 0 && !has_setpoints())
      throw InputError(fmt::format("move_suppression[{0}] and target_weight[{0}]", i), "both 0",
                       "at least one > 0: without setpoints the moves would not be determined");
  mv_hard.validate("mv_hard", mv_count);
  cv_hard.validate("cv_hard", cv_count);
  cv_soft.validate("cv_soft", cv_count);
  require_weights("slack_weight", slack_weight, cv_count);
  for (Eigen::Index i = 0; i < cv_count; ++i)
    if (has_soft_limit(i) && slack_weight(i) == 0)
      throw InputError(fmt::format("slack_weight[{}]", i), "0", "a number > 0 for a CV with a soft limit");
  if (mv_cost.size() != mv_count || !mv_cost.allFinite())
    throw InputError(
        "mv_cost", fmt::format("{} numbers{}", mv_cost.size(), mv_cost.allFinite() ? "" : ", not all finite"),
        fmt::format("{} finite ones", mv_count));
  if (!(std::isfinite(target_violation_cost) && target_violation_cost > 0))
    throw InputError("target_violation_cost", fmt::format("{}", target_violation_cost), "a number > 0");
}

bool operator==(const Limits& a, const Limits& b) {
  return same_members(members(a), members(b));
}

bool operator==(const MpcOptions& a, const MpcOptions& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
