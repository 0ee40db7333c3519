// [controller]

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/transfer_function_keys.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

// Bounds on the size of the matrices and of the history of inputs that a file can ask for.
constexpr std::int64_t kMaxHorizon = 2000;
constexpr double kMostProgramNumbers =
    5e7;  // numbers in the quadratic program; a controller holds several copies

/// Default for CVs that integrate: an unknown flow into a level is found within about twenty samples. A
/// larger value makes the moves noisier.
constexpr double kBiasRamp = 0.05;

void set_limits(Limits& limits, Eigen::Index i, const NumberPair& range) {
  limits.lower(i) = range.first;
  limits.upper(i) = range.second;
}

struct MvOptions {
  double cost = 0.0, move_suppression = 0.0, target_weight = 0.0;
  double move_limit = kInfinity, resting_value = 0.0, resting_weight = 0.0;
  NumberPair hard;
};

OptionKeys keys(MvOptions& mv) {
  // The cost decides where the target lies, so an MV with a target must have one.
  const auto read_cost = [&mv](const TomlTable& table) {
    const bool rests = table.has("resting_weight");
    if (rests != table.has("resting_value"))
      table.refuse(rests ? "resting_weight" : "resting_value", "one of resting_value and resting_weight",
                   "both or none");
    mv.cost = mv.target_weight > 0 && !rests ? read_number(table, "cost", NumberRule::finite())
                                             : read_number_or(table, "cost", NumberRule::finite(), 0.0);
    if (table.has("move_limit"))
      mv.move_limit = read_number(table, "move_limit", NumberRule::positive());
    if (!rests)
      return;
    if (mv.target_weight == 0)
      table.refuse("resting_value", "a resting value without a target", "a target_weight above 0");
    mv.resting_value = read_number(table, "resting_value", NumberRule::finite());
    mv.resting_weight = read_number(table, "resting_weight", NumberRule::positive());
  };
  return {key::option("cost", "number", "phi_u of (6.19)", "1 / MV")
              .otherwise("required with a target and without a resting value")
              .allow("finite"),
          key::number("move_suppression", mv.move_suppression, NumberRule::at_least(0), "Q_du of (6.20)",
                      "1 / MV^2")
              .required(),
          key::number("target_weight", mv.target_weight, NumberRule::at_least(0),
                      "Q_u of (6.20). Weights that leave a move undetermined are refused, for example both "
                      "weights 0 and no setpoint, or too few setpoints",
                      "1 / MV^2")
              .otherwise("0: no target"),
          key::option("resting_value", "number",
                      "ideal resting value: the MV rests here if the limits of the CVs allow it. "
                      "`resting_weight` times the squared distance is added to (6.19)",
                      "MV")
              .otherwise("none")
              .allow("finite; with `resting_weight` and a target"),
          key::option("resting_weight", "number", "weight of the distance from `resting_value`", "1 / MV^2")
              .otherwise("none")
              .allow("> 0"),
          key::check(read_cost),
          key::limits("hard", mv.hard, "hard limits", "MV"),
          key::option("move_limit", "number", "hard limit on the move of one sample", "MV")
              .otherwise("none")
              .allow("> 0")};
}

OptionKey analyser_period(AnalyserTiming& timing, const char* meaning) {
  return key::whole("analyser_period", timing.period, 1, kMaxHorizon, meaning, "samples");
}

OptionKey analyser_delay(AnalyserTiming& timing, const char* meaning) {
  return key::whole("analyser_delay", timing.delay, 0, kMaxHorizon, meaning, "samples");
}

struct CvOptions {
  double setpoint_weight = 0.0, setpoint = 0.0, slack_weight = 0.0, slack_cost = 0.0, reference_time = 0.0;
  std::optional<double> bias_ramp;
  NumberPair soft{-kInfinity, kInfinity}, hard;
  AnalyserTiming analyser;
};

/// Reads a CV, which has a setpoint, a soft range, or both.
void read_setpoint_and_range(const TomlTable& table, CvOptions& cv) {
  const bool has_setpoint = table.has("setpoint_weight");
  if (table.has("setpoint") && !has_setpoint)
    table.refuse("setpoint", "a setpoint without setpoint_weight", "both or none");
  const bool has_range = table.has("soft") || table.has("slack_weight") || table.has("slack_cost");
  if (!has_setpoint && !has_range)
    table.refuse("", "neither a setpoint nor a range",
                 "setpoint_weight for a setpoint, slack_weight and soft for a range, or all three");
  if (has_setpoint) {
    cv.setpoint_weight = read_number(table, "setpoint_weight", NumberRule::positive());
    cv.setpoint = read_number_or(table, "setpoint", NumberRule::finite(), 0.0);
  }
  if (table.has("reference_time") && !has_setpoint)
    table.refuse("reference_time", "a reference trajectory without a setpoint", "setpoint_weight beside it");
  if (table.has("reference_time"))
    cv.reference_time = read_number(table, "reference_time", NumberRule::positive());
  if (table.has("bias_ramp"))
    cv.bias_ramp = read_number(table, "bias_ramp", NumberRule::share());
  if (table.has("slack_cost"))
    cv.slack_cost = read_number(table, "slack_cost", NumberRule::positive());
  if (!has_range)
    return;
  if (table.has("slack_weight") || cv.slack_cost == 0.0)
    cv.slack_weight = read_number(table, "slack_weight", NumberRule::positive());
  cv.soft = read_limits(table, "soft");
  if (lies_outside(cv.soft, cv.hard))
    table.refuse("soft", fmt::format("[{}, {}]", cv.soft.first, cv.soft.second),
                 fmt::format("limits within the hard ones [{}, {}]", cv.hard.first, cv.hard.second));
}

OptionKeys keys(CvOptions& cv) {
  return {
      key::option("setpoint_weight", "number", "Q_y of (2.26), W of (3.30)", "1 / CV^2")
          .otherwise("none: no setpoint")
          .allow("> 0"),
      key::option("setpoint", "number", "setpoint at the start; `simulation.step` changes it", "CV")
          .otherwise("0")
          .allow("finite; with `setpoint_weight`"),
      key::option("slack_weight", "number", "tau_y of (6.20)", "1 / CV^2")
          .otherwise("required with `soft` and without `slack_cost`")
          .allow("> 0"),
      key::option("slack_cost", "number",
                  "linear cost of a violation of the soft limits, beside or instead of `slack_weight`",
                  "1 / CV")
          .otherwise("none")
          .allow("> 0"),
      key::option("reference_time", "number",
                  "time constant of the reference trajectory, along which the CV approaches its setpoint "
                  "from where it is",
                  "time")
          .otherwise("none: at once")
          .allow("> 0; with `setpoint_weight`"),
      key::option("bias_ramp", "number",
                  "share of the change of the output bias from one sample to the next that counts as its "
                  "ramp. 0: the bias is a constant, and an unknown flow leaves an offset")
          .otherwise(fmt::format("{} for a CV that integrates", kBiasRamp))
          .allow("0 to 1; for a CV that integrates"),
      key::option("soft", "list of 2 numbers", "soft limits, the range of the CV", "CV")
          .otherwise("required without a setpoint")
          .allow("low <= high; `-inf` and `inf` for no limit; within `hard`"),
      analyser_period(cv.analyser,
                      "for a CV that an analyser measures: samples from one analysis to the next; the "
                      "measurement is held in between"),
      analyser_delay(cv.analyser, "samples from taking a sample of the stream to the result of the analysis")
          .also("below `simulation.samples`"),
      key::limits("hard", cv.hard, "hard limits; a loop that cannot keep them is infeasible", "CV"),
      key::check([&cv](const TomlTable& table) { read_setpoint_and_range(table, cv); })};
}

OptionKeys keys(AnalyserTiming& md) {
  return {analyser_period(md, "samples from one measurement to the next; the measurement is held in between"),
          analyser_delay(md, "samples from the measurement until controller and historian receive it")};
}

enum class Tables { of_all, of_some };

/// A table of tables, one for each of the variables, or for some of them; other names are refused.
template <class Variable>
OptionKey variable_tables(const char* name, const std::vector<PlantModel::Variable>& variables,
                          std::function<void(const TomlTable&, Eigen::Index, const Variable&)> take,
                          const char* meaning, Tables which = Tables::of_all) {
  const auto read = [&variables, take, which](const TomlTable& controller, const std::string& key) {
    const std::vector<std::string> names = variable_names(variables);
    const TomlTable tables = controller.table(key, names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (which == Tables::of_some && !tables.has(names[i]))
        continue;
      Variable variable;
      const OptionKeys of_variable = keys(variable);
      const TomlTable table = tables.table(names[i], key_names(of_variable));
      read_keys(table, of_variable);
      take(table, static_cast<Eigen::Index>(i), variable);
    }
  };
  const auto below = [] {
    Variable variable;
    return keys(variable);
  };
  OptionKey tables = key::option(name, "table of tables", meaning).read(read).with(".NAME", below);
  return which == Tables::of_all ? std::move(tables).required() : std::move(tables).otherwise("none");
}

void resize(Study& study) {
  MpcOptions& options = study.controller;
  const Eigen::Index cvs = study.cv_count(), mvs = study.mv_count();
  for (Eigen::VectorXd* of_mv : {&options.move_suppression, &options.target_weight, &options.mv_cost,
                                 &options.resting_value, &options.resting_weight})
    of_mv->setZero(mvs);
  for (Eigen::VectorXd* of_cv :
       {&options.setpoint_weight, &options.slack_weight, &options.slack_cost, &options.reference_time,
        &options.bias_ramp, &study.simulation.initial_setpoint})
    of_cv->setZero(cvs);
  options.analysers.assign(static_cast<std::size_t>(cvs), {});
  options.md_analysers.assign(static_cast<std::size_t>(study.md_count()), {});
  options.move_limit.setConstant(mvs, kInfinity);
  options.mv_hard = Limits::none(mvs);
  options.cv_hard = Limits::none(cvs);
  options.cv_soft = Limits::none(cvs);
}

/// Refuses dead times and step coefficients of too many samples: a controller keeps past inputs over the
/// longest of them.
void refuse_long_dead_times(const TomlTable& controller, const Study& study) {
  const double sample_time = study.controller.sample_time;
  for (Eigen::Index row = 0; row < study.plant.G.rows(); ++row)
    for (Eigen::Index col = 0; col < study.plant.G.cols(); ++col)
      if (const TransferFunction& channel = study.plant.G(row, col);
          !(channel.memory() / sample_time <= kMaxDeadTimeSamples)) {
        const bool dead = channel.memory() == channel.dead_time();
        controller.refuse("sample_time",
                          fmt::format("{} ({} {:.3g} samples)", sample_time,
                                      dead ? "a dead time has" : "coefficients of a step response reach over",
                                      channel.memory() / sample_time),
                          fmt::format("{} of at most {} samples", dead ? "dead times" : "coefficients",
                                      kMaxDeadTimeSamples));
      }
}

/// Refuses a quadratic program that is too large. It has a column for each planned move, and a row for each
/// planned move and each predicted output.
void refuse_large_program(const TomlTable& controller, const Study& study) {
  const auto outputs = static_cast<double>(study.cv_count() * study.controller.prediction_horizon);
  const auto of_sample = static_cast<double>(study.mv_count());
  const double moves = of_sample * static_cast<double>(study.controller.control_horizon);
  if ((outputs + moves) * moves <= kMostProgramNumbers)
    return;
  const double most = 0.5 * (std::sqrt(outputs * outputs + 4.0 * kMostProgramNumbers) - outputs);
  controller.refuse(
      "control_horizon",
      fmt::format("{} ({} moves and {} predicted outputs)", study.controller.control_horizon, moves, outputs),
      fmt::format("at most {} with this plant and prediction horizon: a quadratic program of {:g} "
                  "numbers",
                  std::floor(most / of_sample), kMostProgramNumbers));
}

OptionKeys controller_program_keys(std::vector<std::string>& command, double& time_limit) {
  return {key::command("command", command,
                       "the program, found in PATH, and its arguments; it runs in the current folder"),
          key::time_limit(time_limit,
                          "wall-clock seconds that one answer may take; a loop that needs more is `failed`")};
}

OptionKey program_key(std::optional<ControllerProgram>& program) {
  constexpr double kTimeLimit = 60.0;  // s
  const auto below = [] {
    std::vector<std::string> command;
    double time_limit = kTimeLimit;
    return controller_program_keys(command, time_limit);
  };
  const auto read = [&program, below](const TomlTable& controller, const std::string& key) {
    std::vector<std::string> command;
    double time_limit = kTimeLimit;
    read_keys(controller.table(key, key_names(below())), controller_program_keys(command, time_limit));
    program = ControllerProgram(std::move(command), time_limit);
  };
  return key::option("program", "table",
                     "the controller is a program ([own_plant.md](own_plant.md#your-own-controller)), which "
                     "receives the numbers of this table")
      .otherwise("none")
      .with("", below)
      .read(read);
}

OptionKeys controller_keys(Study& study) {
  MpcOptions& options = study.controller;
  const auto take_mv = [&options](const TomlTable&, Eigen::Index i, const MvOptions& mv) {
    options.mv_cost(i) = mv.cost;
    options.move_suppression(i) = mv.move_suppression;
    options.target_weight(i) = mv.target_weight;
    options.move_limit(i) = mv.move_limit;
    options.resting_value(i) = mv.resting_value;
    options.resting_weight(i) = mv.resting_weight;
    set_limits(options.mv_hard, i, mv.hard);
  };
  const auto take_cv = [&study, &options](const TomlTable& table, Eigen::Index i, const CvOptions& cv) {
    const bool integrates = study.plant.G.is_integrating(i);
    if (cv.bias_ramp && !integrates)
      table.refuse("bias_ramp", "a ramp of the bias of a CV that does not integrate",
                   "a CV of which a channel has a pole at 0");
    options.setpoint_weight(i) = cv.setpoint_weight;
    options.slack_weight(i) = cv.slack_weight;
    options.slack_cost(i) = cv.slack_cost;
    options.reference_time(i) = cv.reference_time;
    options.bias_ramp(i) = cv.bias_ramp.value_or(integrates ? kBiasRamp : 0.0);
    options.analysers[static_cast<std::size_t>(i)] = cv.analyser;
    study.simulation.initial_setpoint(i) = cv.setpoint;
    set_limits(options.cv_soft, i, cv.soft);
    set_limits(options.cv_hard, i, cv.hard);
  };
  const auto take_md = [&options](const TomlTable&, Eigen::Index i, const AnalyserTiming& md) {
    options.md_analysers[static_cast<std::size_t>(i)] = md;
  };
  const auto read_control_horizon = [&options](const TomlTable& table, const std::string& key) {
    options.control_horizon = static_cast<int>(read_whole(table, key, 1, options.prediction_horizon));
  };
  return {key::check([&study](const TomlTable&) { resize(study); }),
          key::number("sample_time", options.sample_time, NumberRule::positive(), "Ts", "time").required(),
          key::check([&study](const TomlTable& table) { refuse_long_dead_times(table, study); }),
          key::whole("prediction_horizon", options.prediction_horizon, 1, kMaxHorizon, "ph", "samples")
              .required(),
          key::option("control_horizon", "whole number", "mh", "samples")
              .required()
              .allow("1 to `prediction_horizon`; a quadratic program of at most 5e7 numbers")
              .read(read_control_horizon),
          key::check([&study](const TomlTable& table) { refuse_large_program(table, study); }),
          key::option("move_blocks", "list of whole numbers",
                      "move blocking: numbers of samples for which the planned positions of the MVs are "
                      "held, `control_horizon` numbers. The last position is held to the end of the horizon",
                      "samples")
              .otherwise("none: one sample each")
              .allow("1 or more each")
              .read([&options](const TomlTable& table, const std::string& key) {
                const NumberRule rule{
                    .low = 1, .high = kMaxHorizon, .low_included = true, .high_included = true};
                for (const double samples : read_numbers(table, key, rule, kMaxHorizon)) {
                  if (samples != std::floor(samples))
                    table.refuse(key, fmt::format("{}", samples), "whole numbers");
                  options.move_blocks.push_back(static_cast<int>(samples));
                }
              }),
          key::choice("weight_convention", options.weight_convention, {"direct", "squared"},
                      "how `abs(Q x)^2` in (6.20) is read: `\"direct\"` as Q x^2, `\"squared\"` as (Q x)^2. "
                      "Open in the thesis; `\"direct\"` comes close to its results"),
          key::choice("slack", options.slack_form, {"per-sample", "per-cv"},
                      "`\"per-sample\"`: one slack variable for each CV and sample. `\"per-cv\"`: one for "
                      "each CV. Open; with `\"per-sample\"` T0 settles as in (6.24)"),
          key::number("target_violation_cost", options.target_violation_cost, NumberRule::positive(),
                      "price of one unit of steady-state violation of a soft limit, in multiples of the "
                      "largest `cost`. Open: (6.19) has no solution if no target keeps the limits",
                      "1"),
          // A resolved study has this key only if the study sets it: finished boards have the digests of
          // studies without it.
          key::option("solver_time_limit", "number",
                      "processor time that Ipopt may take for one problem, alone or instead of the "
                      "active-set method; a loop that needs more is `failed`",
                      "s")
              .otherwise(fmt::format("{:g}", options.solver_time_limit))
              .allow("> 0")
              .read([&options](const TomlTable& table, const std::string& key) {
                options.solver_time_limit = read_number(table, key, NumberRule::positive());
              }),
          variable_tables<MvOptions>("mv", study.plant.mvs, take_mv, "one table for each MV, under its name"),
          variable_tables<CvOptions>("cv", study.plant.cvs, take_cv, "one table for each CV, under its name"),
          variable_tables<AnalyserTiming>("md", study.plant.mds, take_md,
                                          "one table for each MD that is measured late, under its name",
                                          Tables::of_some),
          key::check([&study](const TomlTable& table) {
            table.located("", [&] {
              return study.controller.validate(study.cv_count(), study.mv_count(), study.md_count());
            });
          }),
          program_key(study.controller_program)};
}

}  // namespace

bool lies_outside(const NumberPair& soft, const NumberPair& hard) {
  const auto outside = [&hard](double limit) {
    return std::isfinite(limit) && (limit < hard.first || limit > hard.second);
  };
  return outside(soft.first) || outside(soft.second);
}

OptionKey controller_key(Study& study) {
  return key::table(
             "controller", [&study] { return controller_keys(study); },
             "the range MPC (6.20) and the target optimizer (6.19)")
      .required();
}

}  // namespace mpm
