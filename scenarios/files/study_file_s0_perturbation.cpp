#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostMultipliers = 1000;

std::vector<double> read_multipliers(const TomlTable& table) {
  const Eigen::VectorXd numbers =
      read_numbers(table, "multipliers", NumberRule::positive(), kMostMultipliers);
  std::vector<double> multipliers(numbers.begin(), numbers.end());
  const auto place = std::adjacent_find(multipliers.begin(), multipliers.end(), std::greater_equal<>());
  if (place != multipliers.end())
    table.refuse("multipliers", fmt::format("{} after {}", *(place + 1), *place), "numbers that grow");
  return multipliers;
}

std::vector<Eigen::Index> read_variables(const TomlTable& table, std::string_view key,
                                         const std::vector<PlantModel::Variable>& variables) {
  std::vector<Eigen::Index> chosen;
  for (const std::size_t i : read_some_of(table, key, variable_names(variables)))
    chosen.push_back(static_cast<Eigen::Index>(i));
  return chosen;
}

/// Section 6.3: no more active limits than MVs that are left to keep them.
void read_fixed_structure(const TomlTable& table, const PlantModel& plant, const MpcOptions& controller,
                          S0PerturbationOptions& options) {
  if (!table.has("fixed_mvs")) {
    if (table.has("fixed_active_cvs"))
      table.refuse("fixed_active_cvs", "a list without fixed_mvs", "a list beside fixed_mvs");
    return;
  }
  options.fixed_mvs = read_variables(table, "fixed_mvs", plant.mvs);
  options.fixed_active_cvs = read_variables(table, "fixed_active_cvs", plant.cvs);
  for (const Eigen::Index cv : options.fixed_active_cvs)
    if (!controller.has_soft_limit(cv))
      table.refuse("fixed_active_cvs",
                   fmt::format("'{}', which has no soft limit", plant.cvs[static_cast<std::size_t>(cv)].name),
                   "CVs with a soft limit");
  const std::size_t left = plant.mvs.size() - options.fixed_mvs.size();
  if (options.fixed_active_cvs.size() > left)
    table.refuse("fixed_active_cvs", fmt::format("{} CVs", options.fixed_active_cvs.size()),
                 fmt::format("at most as many as MVs that are not fixed, {}", left));
}

}  // namespace

S0PerturbationOptions read_s0_perturbation(const TomlTable& document, const PlantModel& plant,
                                           const MpcOptions& controller) {
  S0PerturbationOptions options;
  if (!document.has("s0_perturbation"))
    return options;
  const TomlTable table = document.table("s0_perturbation", study_file_keys("s0_perturbation"));
  options.multipliers = read_multipliers(table);
  if (table.has("cvs"))
    options.cvs = read_variables(table, "cvs", plant.cvs);
  std::tie(options.tolerance_lower, options.tolerance_upper) = read_band_or(
      table, "tolerance", NumberRule::positive(), {options.tolerance_lower, options.tolerance_upper});
  read_fixed_structure(table, plant, controller, options);
  return options;
}

}  // namespace mpm
