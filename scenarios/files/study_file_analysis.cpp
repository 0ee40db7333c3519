#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "plants/non_finite.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxResponse = 100'000;
constexpr std::int64_t kFewestReplications = 100;  // below, a 95 % interval is made of two or three values
constexpr std::int64_t kMaxReplications = 1'000'000;
constexpr double kMaxWindow = 1000;  // in prediction horizons

/// Section 6.3: at most as many soft limits are active as there are MVs, and a limit must be there to be
/// active.
std::vector<Eigen::Index> read_active_cvs(const TomlTable& table, const PlantModel& plant,
                                          const MpcOptions& controller) {
  std::vector<Eigen::Index> active;
  if (!table.has("active_cvs")) {
    return active;
  }
  for (const std::size_t cv : read_some_of(table, "active_cvs", variable_names(plant.cvs))) {
    const auto i = static_cast<Eigen::Index>(cv);
    if (!controller.has_soft_limit(i)) {
      table.refuse("active_cvs", fmt::format("'{}', which has no soft limit", plant.cvs[cv].name),
                   "CVs with a soft limit");
    }
    active.push_back(i);
  }
  if (active.size() > plant.mvs.size()) {
    table.refuse("active_cvs", fmt::format("{} CVs", active.size()),
                 fmt::format("at most as many as MVs, {}", plant.mvs.size()));
  }
  return active;
}

/// A step of a soft limit into the range must not cross the opposite one. CVs without a range (equal limits)
/// have no opposite one.
double narrowest_range(const MpcOptions& controller, const std::vector<Eigen::Index>& active) {
  double narrowest = kInfinity;
  for (Eigen::Index i = 0; i < controller.cv_soft.lower.size(); ++i) {
    const double width = controller.cv_soft.upper(i) - controller.cv_soft.lower(i);
    const bool counts = active.empty() || std::find(active.begin(), active.end(), i) != active.end();
    if (counts && width > 0) {
      narrowest = std::min(narrowest, width);
    }
  }
  return narrowest;
}

}  // namespace

SensitivityOptions read_sensitivity(const TomlTable& document, const PlantModel& plant,
                                    const MpcOptions& controller) {
  const TomlTable table = document.table_or_empty("sensitivity", study_file_keys("sensitivity"));
  SensitivityOptions options;
  options.form = read_choice_or<SensitivityForm>(
      table, "form",
      {{"step-response", SensitivityForm::step_response}, {"box-jenkins", SensitivityForm::box_jenkins}},
      options.form);
  options.samples = static_cast<int>(read_whole_or(table, "samples", 2, kMaxResponse, options.samples));
  options.active_cvs = read_active_cvs(table, plant, controller);
  options.step_size = read_number_or(table, "step_size", NumberRule::positive(), options.step_size);
  options.step_direction = read_choice_or<StepDirection>(table, "step_direction",
                                                         {{"into-range", StepDirection::into_range},
                                                          {"out-of-range", StepDirection::out_of_range},
                                                          {"mean", StepDirection::mean}},
                                                         options.step_direction);
  if (table.has("fixed_mvs")) {
    for (const std::size_t mv : read_some_of(table, "fixed_mvs", variable_names(plant.mvs))) {
      options.fixed_mvs.push_back(static_cast<Eigen::Index>(mv));
    }
  }
  options.structure =
      read_choice_or<SensitivityStructure>(table, "structure",
                                           {{"operating-point", SensitivityStructure::operating_point},
                                            {"by-instant", SensitivityStructure::by_instant}},
                                           options.structure);
  options.switching = read_choice_or<SensitivitySwitching>(
      table, "switching", {{"output", SensitivitySwitching::output}, {"input", SensitivitySwitching::input}},
      options.switching);
  // A structure for every set of constraints, identified in the middle of an experiment, would take minutes.
  if (options.form == SensitivityForm::box_jenkins && options.structure == SensitivityStructure::by_instant)
    table.refuse("form", "'box-jenkins' with the structure 'by-instant'",
                 "'step-response' with it, or 'box-jenkins' with 'operating-point'");
  const double narrowest = narrowest_range(controller, options.active_cvs);
  if (options.step_size > narrowest) {
    table.refuse("step_size", fmt::format("{}", options.step_size),
                 fmt::format("at most the narrowest range between soft limits, {}", narrowest));
  }
  return options;
}

DiagnosisOptions read_diagnosis(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("diagnosis", study_file_keys("diagnosis"));
  DiagnosisOptions options;
  const NumberRule positive = NumberRule::positive();
  std::tie(options.impact_lower, options.impact_upper) =
      read_band_or(table, "impact_band", positive, {options.impact_lower, options.impact_upper});
  options.variance_centre = read_choice_or<VarianceCentre>(
      table, "variance_centre", {{"setpoint", VarianceCentre::setpoint}, {"mean", VarianceCentre::mean}},
      options.variance_centre);
  options.location_distance = read_choice_or<LocationDistance>(
      table, "location_distance",
      {{"linear", LocationDistance::linear}, {"logarithmic", LocationDistance::logarithmic}},
      options.location_distance);
  options.mpm_threshold =
      read_number_or(table, "mpm_threshold", NumberRule::inside(0, 1), options.mpm_threshold);
  std::tie(options.shortest_window, options.longest_window) =
      read_band_or(table, "windows", {.low = 0, .high = kMaxWindow, .high_included = true},
                   {options.shortest_window, options.longest_window});
  options.window_stride =
      static_cast<int>(read_whole_or(table, "window_stride", 1, kMaxResponse, options.window_stride));
  options.source_population = read_choice_or<SourcePopulation>(
      table, "source_population",
      {{"impactful", SourcePopulation::impactful}, {"feasible", SourcePopulation::feasible}},
      options.source_population);
  options.unstable = read_choice_or<UnstableLoops>(
      table, "unstable", {{"keep", UnstableLoops::keep}, {"exclude", UnstableLoops::exclude}},
      options.unstable);
  options.self_check = read_choice_or<SelfCheck>(
      table, "self_check",
      {{"ivar", SelfCheck::ivar}, {"repeat", SelfCheck::repeat}, {"none", SelfCheck::none}},
      options.self_check);
  std::tie(options.self_check_lower, options.self_check_upper) =
      read_band_or(table, "self_check_band", positive, {options.self_check_lower, options.self_check_upper});
  return options;
}

AggregateOptions read_aggregate(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("aggregate", study_file_keys("aggregate"));
  AggregateOptions options;
  options.confidence = read_number_or(table, "confidence", NumberRule::inside(0, 1), options.confidence);
  options.bootstrap_replications =
      static_cast<int>(read_whole_or(table, "bootstrap_replications", kFewestReplications, kMaxReplications,
                                     options.bootstrap_replications));
  return options;
}

std::vector<ReportedValue> read_reported(const TomlTable& document) {
  // Which names there are is known to the findings, not to the reader.
  std::vector<std::string> names;
  if (const toml::node* const node = document.find("reference"); node != nullptr && node->is_table())
    for (const auto& [name, value] : *node->as_table())
      names.emplace_back(name.str());
  const TomlTable table = document.table_or_empty("reference", names);
  std::vector<ReportedValue> values;
  for (const std::string& name : names) {
    ReportedValue value{.name = name, .value = 0.0, .where = table.where(name)};
    if (const toml::node* const node = table.find(name); node != nullptr && node->is_table()) {
      const TomlTable share = table.table(name, study_file_keys("reference.FINDING"));
      value.value = read_number(share, "value",
                                NumberRule{.low = 0, .high = 1, .low_included = true, .high_included = true});
      value.of = read_whole(share, "of", 1, std::numeric_limits<std::int32_t>::max());
    } else {
      value.value = read_number_or(table, name, NumberRule{}, 0.0);
    }
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace mpm
