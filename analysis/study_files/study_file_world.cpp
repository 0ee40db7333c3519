// [world]

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/transfer_function_keys.hpp"
#include "plants/linear/settling_time.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMostWorlds = 10'000, kMostCostLoops = 10'000;
constexpr std::size_t kMostParameters = 200;
constexpr const char* kNoLongMemory = "no channel looks back over more than 1e6 samples";

/// Refuses sizes relative to a noise or a hard limit that does not exist.
void refuse_sizes_of_nothing(const TomlTable& background, const BackgroundRanges& ranges,
                             const Study& study) {
  const Eigen::VectorXd& noise = study.simulation.noise_standard_deviation;
  if (ranges.cv_size.maximum() > 0.0 && (noise.array() == 0.0).any())
    background.refuse("cv_size", "sizes in standard deviations of the noise, which is 0 for a CV",
                      "simulation.noise_standard_deviation > 0 for every CV");
  const Limits& hard = study.controller.mv_hard;
  if (ranges.mv_size.maximum() > 0.0 && !(hard.upper - hard.lower).allFinite())
    background.refuse("mv_size", "sizes relative to the hard limits, which an MV does not have",
                      "controller.mv.NAME.hard with two numbers for every MV");
}

OptionKeys background_keys(BackgroundRanges& ranges, const Study& study) {
  const NumberRule rule = NumberRule::at_least(0);
  return {key::distribution("cv_size", ranges.cv_size, rule,
                            "standard deviation of the disturbance that is added to a CV",
                            "noise standard deviations"),
          key::distribution(
              "mv_size", ranges.mv_size, rule,
              "standard deviation of the disturbance that is added to an MV on its way to the plant",
              "width of the hard limits"),
          key::distribution(
              "time_constant", ranges.time_constant, rule,
              "time constant of the autocorrelation exp(-k / `time_constant`) of both; 0: white", "samples"),
          key::distribution("swell", ranges.swell, NumberRule::positive(),
                            "ratio of their largest to their smallest size: their size rises and falls once "
                            "a record, in each loop at another time",
                            "1"),
          key::check(
              [&ranges, &study](const TomlTable& table) { refuse_sizes_of_nothing(table, ranges, study); })};
}

OptionKeys parameter_keys(WorldParameter& parameter, const Study& study) {
  const auto names = [&study] {
    std::vector<std::string> all;
    if (study.nonlinear)
      for (const NonlinearModel::Parameter& each : study.nonlinear->model.parameters)
        all.push_back(each.name);
    return all;
  };
  const auto read_name = [&parameter, names](const TomlTable& table, const std::string& key) {
    const std::vector<std::string> all = names();
    parameter.name = all[read_one_of(table, key, all)];
  };
  const auto check_ends = [&parameter, &study](const TomlTable& table) {
    for (const NonlinearModel::Parameter& each : study.nonlinear->model.parameters)
      for (const double end : {parameter.factor.minimum(), parameter.factor.maximum()})
        if (each.name == parameter.name)
          table.located("factor", [&] { study.nonlinear->model.check({{each.name, end * each.nominal}}); });
  };
  return {key::option("name", "text", "name of the parameter")
              .required()
              .allow("a parameter of the nonlinear plant, each once")
              .read(read_name),
          key::distribution("factor", parameter.factor, NumberRule::positive(), "factor of its nominal value",
                            "1")
              .required()
              .also("both ends must be possible"),
          key::check(check_ends)};
}

/// Refuses draws with which a channel looks back over too many samples, because they take memory of the
/// program.
void refuse_long_world(const TomlTable& world, const WorldRanges& ranges, const Study& study) {
  const TransferMatrix& G = study.plant.G;
  for (Eigen::Index cv = 0; cv < G.rows() && !study.nonlinear; ++cv)
    for (Eigen::Index input = 0; input < G.cols(); ++input) {
      const TransferFunction& channel = G(cv, input);
      LongestDraws longest;
      const auto check = [&](const char* key, const Distribution& draws) {
        refuse_long_draws(world, key, draws, channel,
                          fmt::format("{}/{}", study.plant.cvs[static_cast<std::size_t>(cv)].name,
                                      input_names(study.plant)[static_cast<std::size_t>(input)]),
                          longest, study.controller.sample_time);
      };
      longest.dead_time_factor = largest_draw(ranges.dead_time_factor);
      check("dead_time_factor", ranges.dead_time_factor);
      longest.dead_time_shift = largest_draw(ranges.dead_time_shift);
      check("dead_time_shift", ranges.dead_time_shift);
      longest.time_factor = largest_draw(ranges.time_constant_factor);
      longest.least_time_factor = ranges.time_constant_factor.minimum();
      check("time_constant_factor", ranges.time_constant_factor);
      longest.lag = largest_draw(ranges.extra_lag) * sum_of_time_constants(channel);
      check("extra_lag", ranges.extra_lag);
    }
}

OptionKeys world_keys(WorldRanges& ranges, const Study& study) {
  const NumberRule positive = NumberRule::positive(), rule = NumberRule::at_least(0);
  // A resolved study of a plant with parameters also has the keys of channels, with their defaults.
  const auto refuse_channels = [&ranges, &study](const TomlTable& world) {
    const WorldRanges none;
    for (const auto& [key, range] : {std::pair("gain_factor", &WorldRanges::gain_factor),
                                     {"time_constant_factor", &WorldRanges::time_constant_factor},
                                     {"dead_time_factor", &WorldRanges::dead_time_factor},
                                     {"dead_time_shift", &WorldRanges::dead_time_shift},
                                     {"extra_lag", &WorldRanges::extra_lag}})
      if (study.nonlinear && !(ranges.*range == none.*range))
        world.refuse(key, "errors of channels of a plant that is not simulated with its linear model",
                     "plant_parameter");
  };
  const auto refuse_parameters = [&study](const TomlTable& world) {
    if (!study.nonlinear && world.has("plant_parameter"))
      world.refuse("plant_parameter", "parameters of a plant that is simulated with its linear model",
                   "the keys of channels, or a nonlinear plant, a program or an FMU");
  };
  const auto take = [&ranges](const TomlTable& table, const WorldParameter& parameter) {
    for (const WorldParameter& other : ranges.plant_parameters)
      if (other.name == parameter.name)
        table.refuse("name", fmt::format("'{}' a second time", parameter.name), "every parameter once");
    ranges.plant_parameters.push_back(parameter);
  };
  return {key::whole("count", ranges.count, 1, kMostWorlds,
                     "number of worlds; the experiments of each kind go to them in turn. Calibration loops "
                     "have as many worlds of their own"),
          key::distribution("gain_factor", ranges.gain_factor, positive,
                            "factor of the gain of a channel of the plant, drawn for each channel", "1"),
          key::distribution("time_constant_factor", ranges.time_constant_factor, positive,
                            "factor of the time constants of a channel", "1")
              .also(kNoLongMemory),
          key::distribution("dead_time_factor", ranges.dead_time_factor, rule,
                            "factor of the dead time of a channel", "1")
              .also(kNoLongMemory),
          key::distribution("dead_time_shift", ranges.dead_time_shift, NumberRule::finite(),
                            "added to the dead time of a channel; a negative sum becomes 0", "time")
              .also(kNoLongMemory),
          key::distribution("extra_lag", ranges.extra_lag, rule,
                            "time constant of a further lag, over the sum of those of the channel", "1")
              .also(kNoLongMemory),
          key::distribution("noise_factor", ranges.noise_factor, rule,
                            "factor of the measurement noise of a CV, in the benchmark as well", "1"),
          key::distribution("valve_curvature", ranges.valve_curvature, NumberRule::inside(-1, 1),
                            "curvature c of the valve of each MV: the plant gets u + c (u - a) (b - u) / (b "
                            "- a), where a and b are the hard limits, less the value of this term at the "
                            "start of the loop. The gain of the valve goes from 1 + c to 1 - c",
                            "1"),
          key::check([&ranges, &study](const TomlTable& world) {
            const Limits& hard = study.controller.mv_hard;
            if (!(ranges.valve_curvature == Distribution::constant(0.0)) &&
                !((hard.upper - hard.lower).allFinite() && (hard.upper.array() > hard.lower.array()).all()))
              world.refuse("valve_curvature", "valves of MVs without a range",
                           "controller.mv.NAME.hard with two different numbers for every MV");
          }),
          key::whole("cost_loops", ranges.cost_loops, 1, kMostCostLoops,
                     "pairs of loops, with the fault and without it; the cost of the fault is averaged over "
                     "their noise"),
          key::whole("repair_loops", ranges.repair_loops, 0, kMostCostLoops,
                     "loops over whose noise the gain of a repair is averaged; each is run once for every "
                     "channel that differs from the model. 0: `repair_gain` is not computed"),
          key::number("repair_screen", ranges.repair_screen, NumberRule::share(),
                      "share of the largest gain in the first of these loops. A channel whose repair brings "
                      "less than this share is not run in the others, and its gain has no standard error. 0: "
                      "every channel is run in all of them",
                      "1"),
          key::list<WorldParameter>(
              "plant_parameter", kMostParameters,
              [&study](WorldParameter& parameter) { return parameter_keys(parameter, study); }, take,
              "parameters of a nonlinear plant, a program or an FMU that differ in a world; they take the "
              "place of the keys for channels")
              .allow("one or more")
              .after(refuse_parameters),
          key::check(refuse_channels),
          key::check([&ranges, &study](const TomlTable& world) { refuse_long_world(world, ranges, study); }),
          key::table(
              "background", [&ranges, &study] { return background_keys(ranges.background, study); },
              "disturbances that never stop: independent first-order noise on every CV and every MV, drawn "
              "anew in each loop")};
}

}  // namespace

OptionKey world_key(Study& study) {
  // The keys, and those of the tables below them, refer to both objects, which must therefore stay alive.
  const auto below = [no_study = std::make_shared<Study>(), ranges = std::make_shared<WorldRanges>()] {
    return world_keys(*ranges, *no_study);
  };
  const auto read = [&study](const TomlTable& document, const std::string& key) {
    WorldRanges ranges;
    const OptionKeys keys = world_keys(ranges, study);
    read_keys(document.table(key, key_names(keys)), keys);
    study.world = std::move(ranges);
  };
  return key::option(
             "world", "table",
             "worlds in which every model is a little wrong; controller and methods know the model and the "
             "benchmark of their world")
      .otherwise("none: the model is exact except for the fault")
      .with("", below)
      .read(read);
}

}  // namespace mpm
