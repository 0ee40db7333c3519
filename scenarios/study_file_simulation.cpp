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

std::vector<DisturbanceStep> read_steps(const TomlTable& simulation, const std::vector<std::string>& mds,
                                        int samples) {
  std::vector<DisturbanceStep> steps;
  std::set<std::pair<Eigen::Index, int>> taken;
  for (const TomlTable& table : simulation.tables("step", study_file_keys("simulation.step[]"))) {
    const DisturbanceStep step{.md = static_cast<Eigen::Index>(read_one_of(table, "md", mds)),
                               .sample = static_cast<int>(read_whole(table, "sample", 0, samples - 1)),
                               .level = read_number(table, "level", NumberRule::finite())};
    if (!taken.emplace(step.md, step.sample).second) {
      table.refuse("sample", fmt::format("{} for a second step of this MD", step.sample),
                   "one step a sample");
    }
    steps.push_back(step);
  }
  std::sort(steps.begin(), steps.end(), [](const DisturbanceStep& a, const DisturbanceStep& b) {
    return std::tie(a.sample, a.md) < std::tie(b.sample, b.md);
  });
  return steps;
}

void read_random_steps(const TomlTable& simulation, SimulationOptions& options) {
  const TomlTable table = simulation.table("random_steps", study_file_keys("simulation.random_steps"));
  options.random_steps = true;
  options.step_interval =
      read_distribution_or(table, "interval", NumberRule::at_least(1), options.step_interval);
  options.step_level = read_distribution_or(table, "level", NumberRule::finite(), options.step_level);
}

/// A plant with MDs is excited by them in one of two ways; one without them cannot be.
void refuse_wrong_excitation(const TomlTable& simulation, const std::vector<std::string>& mds) {
  const bool steps = simulation.has("step");
  const bool random_steps = simulation.has("random_steps");
  if (mds.empty() && (steps || random_steps)) {
    simulation.refuse(steps ? "step" : "random_steps", "steps of measured disturbances",
                      "none, because the plant has no measured disturbance");
  }
  if (!mds.empty() && steps == random_steps) {
    simulation.refuse("", steps ? "both step and random_steps" : "neither step nor random_steps",
                      "exactly one of the two");
  }
}

}  // namespace

SimulationOptions read_simulation(const TomlTable& document, const PlantModel& plant) {
  const TomlTable table = document.table("simulation", study_file_keys("simulation"));
  const std::vector<std::string> mds = variable_names(plant.mds);
  SimulationOptions options;
  options.samples = static_cast<int>(read_whole(table, "samples", 1, kMaxSamples));
  options.noise_standard_deviation = read_noise(table, variable_names(plant.cvs));
  refuse_wrong_excitation(table, mds);
  if (table.has("step")) {
    options.steps = read_steps(table, mds, options.samples);
  }
  if (table.has("random_steps")) {
    read_random_steps(table, options);
  }
  return options;
}

}  // namespace mpm
