#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "scenarios/study_file_keys.hpp"
#include "scenarios/study_file_parts.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxSamples = 1'000'000;

/// One number for all CVs, or a table with one a CV.
Eigen::VectorXd read_noise(const TomlTable& simulation, const std::vector<std::string>& cvs) {
  const std::string key = "noise_standard_deviation";
  const NumberRule rule = NumberRule::at_least(0);
  const auto count = static_cast<Eigen::Index>(cvs.size());
  const toml::node& node = simulation.require(key, "a number >= 0, or a table with one for each CV");
  if (!node.is_table()) {
    return Eigen::VectorXd::Constant(count, read_number(simulation, key, rule));
  }
  const TomlTable table = simulation.table(key, cvs);
  Eigen::VectorXd noise(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    noise(i) = read_number(table, cvs[static_cast<std::size_t>(i)], rule);
  }
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

/// MDs are excited in one of two ways, setpoints by steps; a loop without both cannot be excited.
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
  const bool excited = random_steps || !options.steps.empty() || !options.setpoint_steps.empty();
  if (!excited && !(mds.empty() && setpoint_cvs.empty())) {
    simulation.refuse("", "neither step nor random_steps", "steps of setpoints or MDs, or random_steps");
  }
}

}  // namespace

SimulationOptions read_simulation(const TomlTable& document, const PlantModel& plant,
                                  const MpcOptions& controller) {
  const TomlTable table = document.table("simulation", study_file_keys("simulation"));
  const std::vector<std::string> mds = variable_names(plant.mds);
  SimulationOptions options;
  options.samples = static_cast<int>(read_whole(table, "samples", 1, kMaxSamples));
  options.noise_standard_deviation = read_noise(table, variable_names(plant.cvs));
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
  refuse_wrong_excitation(table, mds, setpoint_cvs, options);
  return options;
}

}  // namespace mpm
