#include "solvers/mpc_options.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/same_members.hpp"

namespace mpm {
namespace {

void require_weights(const char* name, const Eigen::VectorXd& weights, Eigen::Index size) {
  if (weights.size() != size)
    throw InputError(name, fmt::format("{} numbers", weights.size()), fmt::format("{}", size));
  for (Eigen::Index i = 0; i < size; ++i)
    if (!std::isfinite(weights(i)) || weights(i) < 0)
      throw InputError(fmt::format("{}[{}]", name, i), fmt::format("{}", weights(i)), "a number >= 0");
}

bool has(const Eigen::VectorXd& of_some, Eigen::Index i) {
  return of_some.size() > 0 && of_some(i) > 0.0;
}

void require_optional_weights(const char* name, const Eigen::VectorXd& weights, Eigen::Index size) {
  if (weights.size() > 0)
    require_weights(name, weights, size);
}

void require_move_blocks(const MpcOptions& options) {
  const std::vector<int>& blocks = options.move_blocks;
  const std::string found = fmt::format("{}", fmt::join(blocks, ", "));
  if (static_cast<int>(blocks.size()) != options.control_horizon)
    throw InputError("move_blocks", fmt::format("{} blocks", blocks.size()),
                     fmt::format("{}, the control horizon", options.control_horizon));
  if (std::any_of(blocks.begin(), blocks.end(), [](int samples) { return samples < 1; }))
    throw InputError("move_blocks", found, "blocks of 1 sample or more");
  if (options.move_starts().back() >= options.prediction_horizon)
    throw InputError(
        "move_blocks", found,
        fmt::format("blocks of which the last begins within the prediction horizon of {} samples",
                    options.prediction_horizon));
}

void require_timings(const char* name, const std::vector<AnalyserTiming>& timings, Eigen::Index count) {
  if (!timings.empty() && static_cast<Eigen::Index>(timings.size()) != count)
    throw InputError(name, fmt::format("{}", timings.size()), fmt::format("{}, or none", count));
  for (const AnalyserTiming& timing : timings)
    if (timing.period < 1 || timing.delay < 0 || timing.first < 0 || timing.first >= timing.period)
      throw InputError(
          name, fmt::format("period {}, delay {}, first {}", timing.period, timing.delay, timing.first),
          "period >= 1, delay >= 0, first from 0 to period - 1");
}

auto members(const Limits& limits) {
  const auto& [lower, upper] = limits;
  return std::tie(lower, upper);
}

auto members(const MpcOptions& options) {
  const auto& [sample_time, prediction_horizon, control_horizon, move_suppression, target_weight,
               setpoint_weight, slack_weight, slack_cost, reference_time, bias_ramp, analysers, md_analysers,
               move_blocks, weight_convention, slack_form, mv_hard, move_limit, cv_hard, cv_soft, mv_cost,
               resting_value, resting_weight, target_violation_cost, solver_time_limit] = options;
  return std::tie(sample_time, prediction_horizon, control_horizon, move_suppression, target_weight,
                  setpoint_weight, slack_weight, slack_cost, reference_time, bias_ramp, analysers,
                  md_analysers, move_blocks, weight_convention, slack_form, mv_hard, move_limit, cv_hard,
                  cv_soft, mv_cost, resting_value, resting_weight, target_violation_cost, solver_time_limit);
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

bool MpcOptions::has_reference(Eigen::Index cv) const {
  return has(reference_time, cv);
}

bool MpcOptions::has_slack_cost(Eigen::Index cv) const {
  return has(slack_cost, cv);
}

bool MpcOptions::has_bias_ramps() const {
  return (bias_ramp.array() > 0.0).any();
}

bool MpcOptions::has_resting_values() const {
  return (resting_weight.array() > 0.0).any();
}

bool MpcOptions::has_move_limits() const {
  return move_limit.array().isFinite().any();
}

std::vector<int> MpcOptions::move_starts() const {
  std::vector<int> starts(static_cast<std::size_t>(control_horizon));
  for (std::size_t i = 1; i < starts.size(); ++i)
    starts[i] = starts[i - 1] + (move_blocks.empty() ? 1 : move_blocks[i - 1]);
  return starts;
}

bool MpcOptions::has_soft_limit(Eigen::Index cv) const {
  return std::isfinite(cv_soft.lower(cv)) || std::isfinite(cv_soft.upper(cv));
}

bool MpcOptions::has_soft_limits() const {
  return cv_soft.lower.array().isFinite().any() || cv_soft.upper.array().isFinite().any();
}

void MpcOptions::validate(Eigen::Index cv_count, Eigen::Index mv_count, Eigen::Index md_count) const {
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
  require_optional_weights("slack_cost", slack_cost, cv_count);
  for (Eigen::Index i = 0; i < cv_count; ++i)
    if (has_soft_limit(i) && slack_weight(i) == 0 && !has_slack_cost(i))
      throw InputError(fmt::format("slack_weight[{}]", i), "0", "a number > 0 for a CV with a soft limit");
  require_optional_weights("reference_time", reference_time, cv_count);
  require_optional_weights("bias_ramp", bias_ramp, cv_count);
  if ((bias_ramp.array() > 1.0).any())
    throw InputError("bias_ramp", fmt::format("{}", bias_ramp.maxCoeff()), "numbers from 0 to 1");
  require_timings("analysers", analysers, cv_count);
  require_timings("md_analysers", md_analysers, md_count);
  require_optional_weights("resting_weight", resting_weight, mv_count);
  if (resting_weight.size() != resting_value.size() || !resting_value.allFinite())
    throw InputError("resting_value", fmt::format("{} numbers", resting_value.size()),
                     "a finite number for each resting_weight");
  if (move_limit.size() > 0 && (move_limit.size() != mv_count || !(move_limit.array() > 0.0).all()))
    throw InputError("move_limit", fmt::format("{} numbers", move_limit.size()),
                     fmt::format("{} numbers > 0; infinite: no limit", mv_count));
  if (!move_blocks.empty())
    require_move_blocks(*this);
  if (mv_cost.size() != mv_count || !mv_cost.allFinite())
    throw InputError(
        "mv_cost", fmt::format("{} numbers{}", mv_cost.size(), mv_cost.allFinite() ? "" : ", not all finite"),
        fmt::format("{} finite ones", mv_count));
  if (!(std::isfinite(target_violation_cost) && target_violation_cost > 0))
    throw InputError("target_violation_cost", fmt::format("{}", target_violation_cost), "a number > 0");
  if (!(solver_time_limit > 0))
    throw InputError("solver_time_limit", fmt::format("{}", solver_time_limit), "a number > 0");
}

bool operator==(const Limits& a, const Limits& b) {
  return same_members(members(a), members(b));
}

bool operator==(const MpcOptions& a, const MpcOptions& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
