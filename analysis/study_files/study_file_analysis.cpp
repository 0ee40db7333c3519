// [sensitivity], [s0_perturbation], [diagnosis], [aggregate], [reference]

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/study_files/study_file_parts.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxResponse = 100'000;
constexpr std::int64_t kFewestReplications = 100;  // with fewer, two or three values make a 95 % interval
constexpr std::int64_t kMaxReplications = 1'000'000;
constexpr double kMaxWindow = 1000;  // in prediction horizons
constexpr std::size_t kMostMultipliers = 1000;

/// Refuses a wrong list of CVs whose soft limit is active. Section 6.3: at most `most` CVs, each with a soft
/// limit.
void refuse_wrong_active(const TomlTable& table, const char* key, const std::vector<Eigen::Index>& active,
                         const Study& study, std::size_t most, const char* of) {
  for (const Eigen::Index cv : active)
    if (!study.controller.has_soft_limit(cv))
      table.refuse(
          key,
          fmt::format("'{}', which has no soft limit", study.plant.cvs[static_cast<std::size_t>(cv)].name),
          "CVs with a soft limit");
  if (active.size() > most)
    table.refuse(key, fmt::format("{} CVs", active.size()),
                 fmt::format("at most as many as {}, {}", of, most));
}

/// Returns the narrowest range of the active CVs: a step of a soft limit into the range must not cross the
/// opposite limit. CVs without a range (equal limits) do not count.
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

OptionKeys sensitivity_keys(Study& study) {
  SensitivityOptions& options = study.sensitivity;
  const auto check_active = [&study](const TomlTable& table) {
    refuse_wrong_active(table, "active_cvs", study.sensitivity.active_cvs, study, study.plant.mvs.size(),
                        "MVs");
  };
  const auto check_all = [&study](const TomlTable& table) {
    const SensitivityOptions& read = study.sensitivity;
    // Identifying a structure for every set of constraints in the middle of an experiment would take minutes.
    if (read.form == SensitivityForm::box_jenkins && read.structure == SensitivityStructure::by_instant)
      table.refuse("form", "'box-jenkins' with the structure 'by-instant'",
                   "'step-response' with it, or 'box-jenkins' with 'operating-point'");
    if (const double narrowest = narrowest_range(study.controller, read.active_cvs);
        read.step_size > narrowest)
      table.refuse("step_size", fmt::format("{}", read.step_size),
                   fmt::format("at most the narrowest range between soft limits, {}", narrowest));
  };
  return {
      key::choice("form", options.form, {"step-response", "box-jenkins"},
                  "form of T0: the step responses themselves (A3.1), or models identified in a record with a "
                  "moving reference (A3.2; not with the structure `\"by-instant\"`)"),
      key::whole(
          "samples", options.samples, 2, kMaxResponse,
          "length of the step responses, long enough for them to settle; the static gain holds from there on",
          "samples"),
      key::number("step_size", options.step_size, NumberRule::positive(),
                  "size of the step of a soft limit, small enough that no other limit becomes active", "CV")
          .allow("> 0, at most the narrowest range between the soft limits of the active CVs"),
      key::choice("step_direction", options.step_direction, {"into-range", "out-of-range", "mean"},
                  "direction of the step of the limit. Open: a range MPC responds differently to the two "
                  "directions (docs/methods.md, T0)"),
      key::some_of(
          "active_cvs", options.active_cvs, [&study] { return variable_names(study.plant.cvs); },
          "CVs whose soft limit is active. Section 6.3: at most as many as MVs")
          .otherwise("the active ones of the basis case")
          .allow("names of CVs with a soft limit, none twice, at most as many as MVs"),
      key::check(check_active),
      key::some_of(
          "fixed_mvs", options.fixed_mvs, [&study] { return variable_names(study.plant.mvs); },
          "MVs that are held while T0 is determined (assumption B of 3.3.3), besides the MVs at a hard limit")
          .otherwise("none")
          .allow("names of MVs, none twice"),
      key::choice(
          "structure", options.structure, {"operating-point", "by-instant"},
          "`\"operating-point\"`: S0 of the basis case at every sample (assumption A). `\"by-instant\"`: at "
          "each sample, S0 of the setpoints, soft limits and MV limits that are active there (assumption C)"),
      key::choice("switching", options.switching, {"output", "input"},
                  "with `by-instant`. `\"output\"`: the S0 of a sample acts on the whole past. `\"input\"`: "
                  "each error propagates with the S0 of its own time. Open; in table 3.7 `\"output\"` is "
                  "nearer to the basis case"),
      key::check(check_all)};
}

OptionKeys s0_perturbation_keys(Study& study) {
  S0PerturbationOptions& options = study.s0_perturbation;
  const auto read_multipliers = [&options](const TomlTable& table, const std::string& key) {
    const Eigen::VectorXd numbers = read_numbers(table, key, NumberRule::positive(), kMostMultipliers);
    options.multipliers.assign(numbers.begin(), numbers.end());
    const auto place = std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>());
    if (place != numbers.end())
      table.refuse(key, fmt::format("{} after {}", *(place + 1), *place), "numbers in ascending order");
  };
  const auto names = [](const std::vector<PlantModel::Variable>& variables) {
    return [&variables] { return variable_names(variables); };
  };
  const auto check_structure = [&study](const TomlTable& table) {
    const S0PerturbationOptions& read = study.s0_perturbation;
    if (!table.has("fixed_mvs") && table.has("fixed_active_cvs"))
      table.refuse("fixed_active_cvs", "a list without fixed_mvs", "a list beside fixed_mvs");
    if (table.has("fixed_mvs") && !table.has("fixed_active_cvs"))
      read_some_of(table, "fixed_active_cvs", variable_names(study.plant.cvs));
    refuse_wrong_active(table, "fixed_active_cvs", read.fixed_active_cvs, study,
                        study.plant.mvs.size() - read.fixed_mvs.size(), "MVs that are not fixed");
  };
  return {key::option("multipliers", "list of numbers", "factors of time constant and damping", "1")
              .required()
              .allow("1 to 1000 numbers > 0 in ascending order")
              .read(read_multipliers),
          key::some_of("cvs", options.cvs, names(study.plant.cvs), "CVs whose experiments are examined")
              .otherwise("all at an active limit")
              .allow("names of CVs at an active soft limit, none twice"),
          key::band("tolerance", options.tolerance_lower, options.tolerance_upper, NumberRule::positive(),
                    "range of multipliers over which the largest change is taken", "1"),
          key::some_of("fixed_mvs", options.fixed_mvs, names(study.plant.mvs),
                       "MVs that are not available in a second control structure")
              .otherwise("none")
              .allow("names of MVs, none twice"),
          key::some_of("fixed_active_cvs", options.fixed_active_cvs, names(study.plant.cvs),
                       "CVs whose soft limit is active in it")
              .otherwise("required with `fixed_mvs`, else none")
              .allow("names of CVs with a soft limit, none twice, at most as many as MVs that are left"),
          key::check(check_structure)};
}

OptionKeys diagnosis_keys(DiagnosisOptions& options, ChainOptions& chain) {
  const NumberRule positive = NumberRule::positive();
  return {
      key::band("impact_band", options.impact_lower, options.impact_upper, positive,
                "an experiment whose Ivar (6.7) lies outside of the band is impactful (section 6.5.2)", "1"),
      key::choice(
          "impact", options.impact,
          "what shows the impact of a fault in a world, beside the cost of the whole loop: the variance of a "
          "CV, or its cost in the controller from the onset on (`cost_ratio` of the archive)"),
      key::choice("variance_centre", options.variance_centre, {"setpoint", "mean"},
                  "centre of the variances of a CV with a setpoint, (3.24) or (2.20). For a CV in a range it "
                  "is the mean"),
      key::choice("location_distance", options.location_distance, {"linear", "logarithmic"},
                  "distance of Ivar_diag (6.8) from 1, which locates the CV. Open; `\"logarithmic\"` treats "
                  "1/2 like 2"),
      key::number("mpm_threshold", chain.mpm_threshold, NumberRule::inside(0, 1),
                  "I_MPM (6.15) above it means a mismatch (figure 6.21)", "1"),
      key::band("windows", options.shortest_window, options.longest_window,
                {.low = 0, .high = kMaxWindow, .high_included = true},
                "shortest and longest moving window of (6.13) and (6.14). Skewness and kurtosis need at "
                "least 4 values",
                "prediction horizons")
          .also("at least 4 samples"),
      key::whole("window_stride", options.window_stride, 1, kMaxResponse,
                 "step from one window length to the next. Open", "samples"),
      key::choice("source_population", options.source_population, {"impactful", "feasible"},
                  "experiments that the rates of I_MPM count. Open"),
      key::choice(
          "unstable", options.unstable, {"keep", "exclude"},
          "treatment of an experiment whose loop is unstable (`spectral_radius` of the archive 1 or more). "
          "`\"keep\"`: it counts like any other. `\"exclude\"`: it is left out like an infeasible one"),
      key::choice(
          "self_check", options.self_check, {"ivar", "repeat", "none"},
          "index that must lie in `self_check_band` for every CV. `\"ivar\"`: Ivar (6.7) of the basis case. "
          "`\"repeat\"`: "
          "Ivar_basis (6.22) of the basis case with other noise, for studies without excitation "
          "([methods.md](methods_thesis.md#records-and-excitation)). `\"none\"`: nothing. With the first two "
          "T0 must have settled, too ([methods.md](methods_thesis.md#diagnosis))"),
      key::band("self_check_band", options.self_check_lower, options.self_check_upper, positive,
                "band in which the index of the self-check must lie for every CV", "1")};
}

OptionKeys aggregate_keys(AggregateOptions& options) {
  return {
      key::number("confidence", options.confidence, NumberRule::inside(0, 1), "confidence of all intervals"),
      key::whole("bootstrap_replications", options.bootstrap_replications, kFewestReplications,
                 kMaxReplications, "number of resamplings for intervals without a formula")};
}

OptionKeys share_keys(ReportedValue& share) {
  return {key::number("value", share.value, NumberRule::share(), "the share").required(),
          key::whole("of", share.of, 1, std::numeric_limits<std::int32_t>::max(),
                     "number of experiments behind a reported share")
              .required()};
}

/// Only the findings know which names exist, so the reader accepts all.
void read_reported(const TomlTable& document, const std::string& key, std::vector<ReportedValue>& values) {
  std::vector<std::string> names;
  if (const toml::table* const findings = document.find(key)->as_table())
    for (const auto& [name, value] : *findings)
      names.emplace_back(name.str());
  const TomlTable table = document.table(key, names);
  for (const std::string& name : names) {
    ReportedValue value{.name = name, .value = 0.0, .where = table.where(name)};
    const OptionKeys keys = share_keys(value);
    if (table.find(name)->is_table())
      read_keys(table.table(name, key_names(keys)), keys);
    else
      value.value = read_number(table, name, NumberRule::finite());
    values.push_back(std::move(value));
  }
}

OptionKeys reported_keys() {
  return {key::option("FINDING", "number, or table",
                      "a number beside the finding of this name, in quotes: `\"mpm.located\" = 0.89`")
              .otherwise("none")
              .allow("any")
              .with("", [] {
                ReportedValue value{.name = "", .value = 0.0};
                return share_keys(value);
              })};
}

}  // namespace

OptionKeys analysis_keys(Study& study) {
  return {key::table(
              "sensitivity", [&study] { return sensitivity_keys(study); },
              "how the nominal sensitivity is determined"),
          key::optional_table(
              "s0_perturbation", [&study] { return s0_perturbation_keys(study); },
              "what an error in the nominal sensitivity costs")
              .otherwise("none: S0 is not perturbed"),
          key::table(
              "diagnosis",
              [&study] { return diagnosis_keys(study.diagnosis, study.assessment.of<ChainOptions>()); },
              "the open choices of the diagnosis")};
}

OptionKey aggregate_key(Study& study) {
  return key::table(
      "aggregate", [&study] { return aggregate_keys(study.aggregate); }, "intervals of the aggregates");
}

OptionKey reference_key(Study& study) {
  const auto read = [&study](const TomlTable& document, const std::string& key) {
    read_reported(document, key, study.reported);
  };
  return key::option("reference", "table", "reported numbers, shown beside the results")
      .otherwise("none")
      .with("", reported_keys)
      .read(read);
}

}  // namespace mpm
