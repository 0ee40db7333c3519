#include <cmath>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

// Bounds on the size of the matrices and of the history of inputs that a file can ask for.
constexpr std::int64_t kMaxHorizon = 2000;

void set_limits(Limits& limits, Eigen::Index i, const NumberPair& range) {
  limits.lower(i) = range.first;
  limits.upper(i) = range.second;
}

void read_mv(const TomlTable& table, Eigen::Index i, MpcOptions& options) {
  options.move_suppression(i) = read_number(table, "move_suppression", NumberRule::at_least(0));
  options.target_weight(i) = read_number_or(table, "target_weight", NumberRule::at_least(0), 0.0);
  // A cost decides where the target lies: an MV with a target has to say it.
  options.mv_cost(i) = options.target_weight(i) > 0
                           ? read_number(table, "cost", NumberRule::finite())
                           : read_number_or(table, "cost", NumberRule::finite(), 0.0);
  set_limits(options.mv_hard, i, read_limits(table, "hard"));
}

/// A soft limit outside of the hard ones could never be reached.
void refuse_soft_outside_hard(const TomlTable& table, const NumberPair& soft, const NumberPair& hard) {
  const auto outside = [&hard](double limit) {
    return std::isfinite(limit) && (limit < hard.first || limit > hard.second);
  };
  if (outside(soft.first) || outside(soft.second)) {
    table.refuse("soft", fmt::format("[{}, {}]", soft.first, soft.second),
                 fmt::format("limits within the hard ones [{}, {}]", hard.first, hard.second));
  }
}

/// A CV has a setpoint, a soft range, or both.
void read_cv(const TomlTable& table, Eigen::Index i, MpcOptions& options) {
  const NumberPair hard = read_limits(table, "hard");
  set_limits(options.cv_hard, i, hard);
  const bool has_setpoint = table.has("setpoint_weight");
  if (table.has("setpoint") && !has_setpoint)
    table.refuse("setpoint", "a setpoint without setpoint_weight", "both or none");
  if (!has_setpoint && !table.has("soft") && !table.has("slack_weight"))
    table.refuse("", "neither a setpoint nor a range",
                 "setpoint_weight for a setpoint, slack_weight and soft for a range, or all three");
  if (has_setpoint)
    options.setpoint_weight(i) = read_number(table, "setpoint_weight", NumberRule::positive());
  if (has_setpoint && !table.has("soft") && !table.has("slack_weight"))
    return;
  options.slack_weight(i) = read_number(table, "slack_weight", NumberRule::positive());
  const NumberPair soft = read_limits(table, "soft");
  refuse_soft_outside_hard(table, soft, hard);
  set_limits(options.cv_soft, i, soft);
}

using ReadVariable = void (*)(const TomlTable&, Eigen::Index, MpcOptions&);

/// One table for each of `names`, none more.
void read_group(const TomlTable& controller, const std::string& group, const std::vector<std::string>& names,
                ReadVariable read, MpcOptions& options) {
  const TomlTable tables = controller.table(group, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const TomlTable table = tables.table(names[i], study_file_keys("controller." + group + ".NAME"));
    read(table, static_cast<Eigen::Index>(i), options);
  }
}

MpcOptions sized_options(Eigen::Index cv_count, Eigen::Index mv_count) {
  MpcOptions options;
  options.move_suppression.setZero(mv_count);
  options.target_weight.setZero(mv_count);
  options.setpoint_weight.setZero(cv_count);
  options.slack_weight.setZero(cv_count);
  options.mv_cost.setZero(mv_count);
  options.mv_hard = Limits::none(mv_count);
  options.cv_hard = Limits::none(cv_count);
  options.cv_soft = Limits::none(cv_count);
  return options;
}

/// A controller keeps as many past inputs as the longest dead time has samples.
void refuse_long_dead_time(const TomlTable& controller, const PlantModel& plant, double sample_time) {
  for (Eigen::Index row = 0; row < plant.G.rows(); ++row) {
    for (Eigen::Index col = 0; col < plant.G.cols(); ++col) {
      const double samples = plant.G(row, col).dead_time() / sample_time;
      if (!(samples <= kMaxDeadTimeSamples)) {
        controller.refuse("sample_time",
                          fmt::format("{} (a dead time has {:.3g} samples)", sample_time, samples),
                          fmt::format("dead times of at most {} samples", kMaxDeadTimeSamples));
      }
    }
  }
}

}  // namespace

MpcOptions read_controller(const TomlTable& document, const PlantModel& plant) {
  const TomlTable table = document.table("controller", study_file_keys("controller"));
  const auto cv_count = static_cast<Eigen::Index>(plant.cvs.size());
  const auto mv_count = static_cast<Eigen::Index>(plant.mvs.size());

  MpcOptions options = sized_options(cv_count, mv_count);
  options.sample_time = read_number(table, "sample_time", NumberRule::positive());
  refuse_long_dead_time(table, plant, options.sample_time);
  options.prediction_horizon = static_cast<int>(read_whole(table, "prediction_horizon", 1, kMaxHorizon));
  options.control_horizon =
      static_cast<int>(read_whole(table, "control_horizon", 1, options.prediction_horizon));
  options.weight_convention = read_choice_or<WeightConvention>(
      table, "weight_convention",
      {{"direct", WeightConvention::direct}, {"squared", WeightConvention::squared}},
      options.weight_convention);
  options.slack_form = read_choice_or<SlackForm>(
      table, "slack", {{"per-sample", SlackForm::per_sample}, {"per-cv", SlackForm::per_cv}},
      options.slack_form);
  options.target_violation_cost =
      read_number_or(table, "target_violation_cost", NumberRule::positive(), options.target_violation_cost);
  read_group(table, "mv", variable_names(plant.mvs), read_mv, options);
  read_group(table, "cv", variable_names(plant.cvs), read_cv, options);
  table.located("", [&] { return options.validate(cv_count, mv_count); });
  return options;
}

std::optional<ControllerProgram> read_controller_program(const TomlTable& document) {
  const TomlTable controller = document.table("controller", study_file_keys("controller"));
  if (!controller.has("program"))
    return std::nullopt;
  const TomlTable program = controller.table("program", study_file_keys("controller.program"));
  constexpr double kTimeLimit = 60.0;  // s
  return ControllerProgram(read_command(program, "command"),
                           read_time_limit_or(program, "time_limit", kTimeLimit));
}

Eigen::VectorXd read_initial_setpoints(const TomlTable& document, const PlantModel& plant,
                                       const MpcOptions& controller) {
  const std::vector<std::string> names = variable_names(plant.cvs);
  const TomlTable tables = document.table("controller", study_file_keys("controller")).table("cv", names);
  Eigen::VectorXd setpoint = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const TomlTable table = tables.table(names[i], study_file_keys("controller.cv.NAME"));
    const auto cv = static_cast<Eigen::Index>(i);
    if (controller.has_setpoint(cv))
      setpoint(cv) = read_number_or(table, "setpoint", NumberRule::finite(), 0.0);
  }
  return setpoint;
}

}  // namespace mpm
