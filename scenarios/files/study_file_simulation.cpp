#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxSamples = 1'000'000;

/// One number for all variables, or a table with one each; `each` says what they are.
Eigen::VectorXd read_deviations(const TomlTable& parent, const std::string& key, const std::string& each,
                                const std::vector<std::string>& names) {
  const NumberRule rule = NumberRule::at_least(0);
  const auto count = static_cast<Eigen::Index>(names.size());
  const toml::node& node =
      parent.require(key, fmt::format("a number >= 0, or a table with one for each {}", each));
  if (!node.is_table()) {
    return Eigen::VectorXd::Constant(count, read_number(parent, key, rule));
  }
  const TomlTable table = parent.table(key, names);
  Eigen::VectorXd deviations(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    deviations(i) = read_number(table, names[static_cast<std::size_t>(i)], rule);
  }
  return deviations;
}

NoiseOptions read_noise(const TomlTable& simulation) {
  const TomlTable table = simulation.table("noise", study_file_keys("simulation.noise"));
  NoiseOptions noise;
  noise.distribution = read_choice_or<NoiseDistribution>(table, "distribution",
                                                         {{"normal", NoiseDistribution::normal},
                                                          {"student", NoiseDistribution::student},
                                                          {"laplace", NoiseDistribution::laplace}},
                                                         noise.distribution);
  noise.autocorrelation =
      read_number_or(table, "autocorrelation", NumberRule::inside(-1, 1), noise.autocorrelation);
  noise.factor = read_distribution_or(table, "factor", NumberRule::at_least(0), noise.factor);
  noise.sequence = read_sequence_or(table, noise.sequence);
  return noise;
}

/// The steps of the MDs and of the setpoints stand in one list; a step names one of the two.
void read_steps(const TomlTable& simulation, const std::vector<std::string>& mds,
                const std::vector<std::string>& setpoint_cvs, const std::vector<Eigen::Index>& cv_of_setpoint,
                SimulationOptions& options) {
  std::set<std::tuple<bool, Eigen::Index, int>> taken;
  for (const TomlTable& table : simulation.tables("step", study_file_keys("simulation.step[]"))) {
    const bool of_md = table.has("md");
    if (of_md == table.has("cv"))
      table.refuse("", of_md ? "both md and cv" : "neither md nor cv", "exactly one of the two");
    if (!of_md && setpoint_cvs.empty())
      table.refuse("cv", "a step of a setpoint, and no CV has one",
                   "none, or a CV with controller.cv.NAME.setpoint_weight");
    if (of_md && mds.empty())
      table.refuse("md", "a step of a measured disturbance, and the plant has none",
                   "none, or an MD of the plant, plant.md[]");
    const SignalStep step{.variable = of_md ? static_cast<Eigen::Index>(read_one_of(table, "md", mds))
                                            : cv_of_setpoint[read_one_of(table, "cv", setpoint_cvs)],
                          .sample = static_cast<int>(read_whole(table, "sample", 0, options.samples - 1)),
                          .level = read_number(table, "level", NumberRule::finite())};
    if (!taken.emplace(of_md, step.variable, step.sample).second) {
      table.refuse("sample", fmt::format("{} for a second step of this variable", step.sample),
                   "one step a sample");
    }
    (of_md ? options.steps : options.setpoint_steps).push_back(step);
  }
  for (std::vector<SignalStep>* steps : {&options.steps, &options.setpoint_steps})
    std::sort(steps->begin(), steps->end(), [](const SignalStep& a, const SignalStep& b) {
      return std::tie(a.sample, a.variable) < std::tie(b.sample, b.variable);
    });
}

void read_random_steps(const TomlTable& simulation, SimulationOptions& options) {
  const TomlTable table = simulation.table("random_steps", study_file_keys("simulation.random_steps"));
  options.random_steps = true;
  options.step_interval =
      read_distribution_or(table, "interval", NumberRule::at_least(1), options.step_interval);
  options.step_level = read_distribution_or(table, "level", NumberRule::finite(), options.step_level);
}

/// A limit may move where there is one: the problems of the controller have a row for it, and no other.
void read_limit_steps(const TomlTable& simulation, const PlantModel& plant, const MpcOptions& controller,
                      SimulationOptions& options) {
  std::set<std::pair<Eigen::Index, int>> taken;
  for (const TomlTable& table : simulation.tables("limit_step", study_file_keys("simulation.limit_step[]"))) {
    const auto cv = static_cast<Eigen::Index>(read_one_of(table, "cv", variable_names(plant.cvs)));
    const auto sample = static_cast<int>(read_whole(table, "sample", 0, options.samples - 1));
    const auto [lower, upper] = read_limits(table, "soft");
    const auto moves = [](double from, double to) { return std::isfinite(from) == std::isfinite(to); };
    const Limits &soft = controller.cv_soft, &hard = controller.cv_hard;
    if (!controller.has_soft_limit(cv))
      table.refuse("cv", "a CV without a soft limit", "a CV with one");
    if (!moves(soft.lower(cv), lower) || !moves(soft.upper(cv), upper) || lower < hard.lower(cv) ||
        upper > hard.upper(cv))
      table.refuse("soft", fmt::format("[{}, {}]", lower, upper),
                   fmt::format("limits where [{}, {}] has them, within the hard ones [{}, {}]",
                               soft.lower(cv), soft.upper(cv), hard.lower(cv), hard.upper(cv)));
    if (!taken.emplace(cv, sample).second)
      table.refuse("sample", fmt::format("{} for a second step of this CV", sample), "one step a sample");
    options.limit_steps.push_back({cv, sample, lower, upper});
  }
  std::sort(options.limit_steps.begin(), options.limit_steps.end(),
            [](const LimitStep& a, const LimitStep& b) {
              return std::tie(a.sample, a.cv) < std::tie(b.sample, b.cv);
            });
}

void read_md_noise(const TomlTable& simulation, const std::vector<std::string>& mds,
                   SimulationOptions& options) {
  if (mds.empty())
    simulation.refuse("md_noise", "variation of measured disturbances",
                      "none, because the plant has no measured disturbance");
  const TomlTable table = simulation.table("md_noise", study_file_keys("simulation.md_noise"));
  options.md_noise_standard_deviation = read_deviations(table, "standard_deviation", "MD", mds);
  options.md_noise_time_constant =
      read_number_or(table, "time_constant", NumberRule::at_least(0), options.md_noise_time_constant);
}

void read_dither(const TomlTable& simulation, const std::vector<std::string>& mvs,
                 SimulationOptions& options) {
  for (const TomlTable& table : simulation.tables("dither", study_file_keys("simulation.dither[]")))
    options.dither.push_back({static_cast<Eigen::Index>(read_one_of(table, "mv", mvs)),
                              read_number(table, "amplitude", NumberRule::positive()),
                              static_cast<int>(read_whole_or(table, "hold", 1, options.samples, 1))});
}

/// MDs are stepped in one of two ways. A loop without any excitation has to be asked for by name: what the
/// variances then compare is noise.
void refuse_wrong_excitation(const TomlTable& simulation, const std::vector<std::string>& mds,
                             const std::vector<std::string>& setpoint_cvs, const SimulationOptions& options) {
  const bool random_steps = simulation.has("random_steps");
  if (mds.empty() && random_steps) {
    simulation.refuse("random_steps", "steps of measured disturbances",
                      "none, because the plant has no measured disturbance");
  }
  if (!options.steps.empty() && random_steps) {
    simulation.refuse("", "both step of an MD and random_steps", "exactly one of the two");
  }
  if (simulation.has("excitation")) {
    read_one_of(simulation, "excitation", {"none"});
    if (options.is_excited())
      simulation.refuse("excitation", "'none' beside steps, md_noise or dither", "one of the two");
  } else if (!options.is_excited() && !(mds.empty() && setpoint_cvs.empty())) {
    simulation.refuse("", "no excitation",
                      "step, random_steps, limit_step, md_noise, dither, or excitation = \"none\"");
  }
}

}  // namespace

SimulationOptions read_simulation(const TomlTable& document, const PlantModel& plant,
                                  const MpcOptions& controller) {
  const TomlTable table = document.table("simulation", study_file_keys("simulation"));
  const std::vector<std::string> mds = variable_names(plant.mds);
  SimulationOptions options;
  options.samples = static_cast<int>(read_whole(table, "samples", 1, kMaxSamples));
  options.noise_standard_deviation =
      read_deviations(table, "noise_standard_deviation", "CV", variable_names(plant.cvs));
  if (table.has("noise"))
    options.noise = read_noise(table);
  options.initial_setpoint = read_initial_setpoints(document, plant, controller);
  std::vector<std::string> setpoint_cvs;
  std::vector<Eigen::Index> cv_of_setpoint;
  for (Eigen::Index cv = 0; cv < controller.setpoint_weight.size(); ++cv) {
    if (controller.has_setpoint(cv)) {
      setpoint_cvs.push_back(plant.cvs[static_cast<std::size_t>(cv)].name);
      cv_of_setpoint.push_back(cv);
    }
  }
  if (table.has("step")) {
    if (mds.empty() && setpoint_cvs.empty()) {
      table.refuse("step", "steps of measured disturbances or setpoints", "none, because there are neither");
    }
    read_steps(table, mds, setpoint_cvs, cv_of_setpoint, options);
  }
  if (table.has("random_steps")) {
    read_random_steps(table, options);
  }
  if (table.has("limit_step"))
    read_limit_steps(table, plant, controller, options);
  if (table.has("md_noise"))
    read_md_noise(table, mds, options);
  if (table.has("dither"))
    read_dither(table, variable_names(plant.mvs), options);
  refuse_wrong_excitation(table, mds, setpoint_cvs, options);
  return options;
}

}  // namespace mpm
