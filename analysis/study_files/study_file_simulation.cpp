// [simulation]

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxSamples = 1'000'000;
constexpr double kMostRecordNumbers = 5e7;      // in the record of a loop, over all variables
constexpr std::size_t kMaxSteps = kMaxSamples;  // of one list

/// Reads one number for all variables, or a table with one number for each. `each` says what the variables
/// are.
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

OptionKeys noise_keys(NoiseOptions& noise) {
  return {key::choice("distribution", noise.distribution, {"normal", "student", "laplace"},
                      "distribution of the innovations, with variance 1. `\"student\"` has 4 degrees of "
                      "freedom, so some values lie far out"),
          key::number(
              "autocorrelation", noise.autocorrelation, NumberRule::inside(-1, 1),
              "phi of e(k) = phi e(k-1) + sqrt(1 - phi^2) w(k), w the innovations; the variance stays", "1"),
          key::distribution("factor", noise.factor, NumberRule::at_least(0),
                            "factor of the noise standard deviations of all CVs, drawn for each experiment; "
                            "the basis case has 1, so an experiment has noise of another size than the "
                            "benchmark. The archive has it as `noise_factor`",
                            "1"),
          sequence_key(noise.sequence,
                       "`\"each\"`: every experiment draws its own innovations. `\"shared\"`: all have the "
                       "same, drawn once for the study, also the basis case; only its repetition "
                       "(`diagnosis.self_check`) has others")};
}

/// Returns the CVs with a setpoint.
std::vector<Eigen::Index> setpoint_cvs(const MpcOptions& controller) {
  std::vector<Eigen::Index> cvs;
  for (Eigen::Index cv = 0; cv < controller.setpoint_weight.size(); ++cv)
    if (controller.has_setpoint(cv))
      cvs.push_back(cv);
  return cvs;
}

OptionKeys step_keys(SignalStep& step, int samples) {
  return {key::option("md", "text", "the measured disturbance that changes")
              .otherwise("this or `cv`")
              .allow("name of an MD"),
          key::option("cv", "text", "the CV whose setpoint changes")
              .otherwise("this or `md`")
              .allow("name of a CV with a setpoint"),
          key::whole("sample", step.sample, 0, samples - 1, "first sample with the new level", "samples")
              .required()
              .allow("0 to `samples` - 1, one step a sample and variable"),
          key::number("level", step.level, NumberRule::finite(),
                      "level from that sample on; an MD begins at 0, a setpoint at `setpoint`", "MD or CV")
              .required()};
}

/// Takes a step from the list, which has the steps of the MDs and those of the setpoints. A step names either
/// an MD or a CV.
void take_step(const TomlTable& table, SignalStep& step, Study& study) {
  const std::vector<std::string> mds = variable_names(study.plant.mds);
  const std::vector<Eigen::Index> cvs = setpoint_cvs(study.controller);
  std::vector<std::string> cv_names;
  for (const Eigen::Index cv : cvs)
    cv_names.push_back(study.plant.cvs[static_cast<std::size_t>(cv)].name);
  const bool of_md = table.has("md");
  if (of_md == table.has("cv"))
    table.refuse("", of_md ? "both md and cv" : "neither md nor cv", "exactly one of the two");
  if (!of_md && cvs.empty())
    table.refuse("cv", "a step of a setpoint, and no CV has one",
                 "none, or a CV with controller.cv.NAME.setpoint_weight");
  if (of_md && mds.empty())
    table.refuse("md", "a step of a measured disturbance, and the plant has none",
                 "none, or an MD of the plant, plant.md[]");
  step.variable = of_md ? static_cast<Eigen::Index>(read_one_of(table, "md", mds))
                        : cvs[read_one_of(table, "cv", cv_names)];
  std::vector<SignalStep>& steps = of_md ? study.simulation.steps : study.simulation.setpoint_steps;
  for (const SignalStep& other : steps)
    if (other.variable == step.variable && other.sample == step.sample)
      table.refuse("sample", fmt::format("{} for a second step of this variable", step.sample),
                   "one step a sample");
  steps.push_back(step);
}

OptionKeys off_keys(OffSpell& spell, const Study& study) {
  const int samples = study.simulation.samples;
  return {key::option("mv", "text", "the MV that operators hold")
              .otherwise("this or `cv`")
              .allow("name of an MV"),
          key::option("cv", "text", "CV that the controller leaves alone")
              .otherwise("this or `mv`")
              .allow("name of a CV"),
          key::whole("sample", spell.sample, 0, samples - 1, "first sample at which it is off", "samples")
              .required()
              .allow("0 to `samples` - 1"),
          key::whole("samples", spell.samples, 1, samples, "for how long", "samples")
              .required()
              .allow("1 to `simulation.samples`; before the next table of this variable"),
          key::option("level", "number", "position at which an MV is held, also outside of its limits", "MV")
              .otherwise("where it was")
              .allow("finite")};
}

/// Refuses a CV that is off if nothing else determines the moves of some MV.
void refuse_undetermined_moves(const TomlTable& table, const Study& study) {
  const MpcOptions& controller = study.controller;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    if (!study.controller_program && controller.move_suppression(mv) == 0.0 &&
        controller.target_weight(mv) == 0.0)
      table.refuse(
          "cv",
          fmt::format("a CV with a setpoint, beside the MV {} without move_suppression and target_weight",
                      study.plant.mvs[static_cast<std::size_t>(mv)].name),
          "one of them above 0 for every MV: without the CV nothing determines the move");
}

void take_off(const TomlTable& table, OffSpell& spell, Study& study) {
  const bool of_mv = table.has("mv");
  if (of_mv == table.has("cv"))
    table.refuse("", of_mv ? "both mv and cv" : "neither mv nor cv", "exactly one of the two");
  spell.sort = of_mv ? VariableSort::mv : VariableSort::cv;
  spell.variable =
      static_cast<Eigen::Index>(of_mv ? read_one_of(table, "mv", variable_names(study.plant.mvs))
                                      : read_one_of(table, "cv", variable_names(study.plant.cvs)));
  if (!of_mv && study.controller.has_setpoint(spell.variable))
    refuse_undetermined_moves(table, study);
  if (!of_mv && table.has("level"))
    table.refuse("level", "where a CV is held", "none, or the MV that is held");
  if (table.has("level"))
    spell.level = read_number(table, "level", NumberRule::finite());
  study.simulation.off.push_back(spell);
}

/// Sorts the periods in which a variable is off. Refuses two of one variable at the same time.
void sort_off(const TomlTable& simulation, Study& study) {
  std::vector<OffSpell>& spells = study.simulation.off;
  const auto in_time = [](const OffSpell& a, const OffSpell& b) {
    return std::tie(a.sample, a.sort, a.variable) < std::tie(b.sample, b.sort, b.variable);
  };
  std::stable_sort(spells.begin(), spells.end(), in_time);
  std::map<std::pair<VariableSort, Eigen::Index>, int> ends;
  for (const OffSpell& spell : spells) {
    const auto& variables = spell.sort == VariableSort::mv ? study.plant.mvs : study.plant.cvs;
    int& end = ends[{spell.sort, spell.variable}];
    if (spell.sample < end)
      simulation.refuse(
          "off",
          fmt::format("a table of {} that begins at sample {}, and one before it that ends at {}",
                      variables[static_cast<std::size_t>(spell.variable)].name, spell.sample, end),
          "tables of one variable one after the other");
    end = spell.end();
  }
}

OptionKeys random_steps_keys(SimulationOptions& options) {
  return {key::check([&options](const TomlTable&) { options.random_steps = true; }),
          key::distribution("interval", options.step_interval, NumberRule::at_least(1),
                            "samples from one step of an MD to the next", "samples"),
          key::distribution("level", options.step_level, NumberRule::finite(), "level after a step", "MD")
              .allow("any")};
}

/// A step of soft limits as written in the file.
struct ListedLimits {
  Eigen::Index cv = 0;
  int sample = 0;
  NumberPair soft;
};

OptionKeys limit_step_keys(ListedLimits& step, const Study& study) {
  return {key::one_of(
              "cv", step.cv, [&study] { return variable_names(study.plant.cvs); }, "the CV whose limits move")
              .allow("name of a CV with a soft limit"),
          key::whole("sample", step.sample, 0, study.simulation.samples - 1,
                     "first sample with the new limits", "samples")
              .required()
              .allow("0 to `samples` - 1, one step a sample and CV"),
          key::limits("soft", step.soft, "soft limits from there on", "CV")
              .allow("low <= high, finite where `controller.cv.NAME.soft` is, within `hard`")};
}

/// Takes a step of soft limits. Only a limit that exists may move, because the problems of the controller
/// have rows for existing limits only.
void take_limit_step(const TomlTable& table, const ListedLimits& step, Study& study) {
  const auto [cv, sample, range] = step;
  const auto [lower, upper] = range;
  const auto moves = [](double from, double to) { return std::isfinite(from) == std::isfinite(to); };
  const Limits &soft = study.controller.cv_soft, &hard = study.controller.cv_hard;
  if (!study.controller.has_soft_limit(cv))
    table.refuse("cv", "a CV without a soft limit", "a CV with one");
  if (!moves(soft.lower(cv), lower) || !moves(soft.upper(cv), upper) ||
      lies_outside(range, {hard.lower(cv), hard.upper(cv)}))
    table.refuse("soft", fmt::format("[{}, {}]", lower, upper),
                 fmt::format("limits where [{}, {}] has them, within the hard ones [{}, {}]", soft.lower(cv),
                             soft.upper(cv), hard.lower(cv), hard.upper(cv)));
  for (const LimitStep& other : study.simulation.limit_steps)
    if (other.cv == cv && other.sample == sample)
      table.refuse("sample", fmt::format("{} for a second step of this CV", sample), "one step a sample");
  study.simulation.limit_steps.push_back({cv, sample, lower, upper});
}

OptionKeys md_noise_keys(Study& study) {
  const auto read_deviation = [&study](const TomlTable& table, const std::string& key) {
    study.simulation.md_noise_standard_deviation =
        read_deviations(table, key, "MD", variable_names(study.plant.mds));
  };
  return {key::option("standard_deviation", "number, or table",
                      "standard deviation of the normal variation: one number for all MDs, or `{d1 = 0.1, d2 "
                      "= 0.2}` with every MD. The variation is measured without error",
                      "MD")
              .required()
              .allow(">= 0")
              .read(read_deviation),
          key::number("time_constant", study.simulation.md_noise_time_constant, NumberRule::at_least(0),
                      "tau of its autocorrelation exp(-t/tau)", "time")
              .otherwise("0: white")};
}

OptionKeys dither_keys(Dither& dither, const Study& study) {
  dither.hold = 1;
  return {key::one_of(
              "mv", dither.mv, [&study] { return variable_names(study.plant.mvs); },
              "MV that the signal is added to")
              .allow("name of an MV"),
          key::number("amplitude", dither.amplitude, NumberRule::positive(),
                      "the signal is + or - this, with the same probability", "MV")
              .required(),
          key::whole("hold", dither.hold, 1, study.simulation.samples,
                     "samples between two draws of the sign", "samples")
              .allow("1 to `samples`")};
}

/// Reads the excitation. MDs are stepped in one of two ways. A loop without any excitation must be asked for
/// explicitly, because its variances compare nothing but noise.
void read_excitation(const TomlTable& simulation, Study& study) {
  SimulationOptions& options = study.simulation;
  const bool has_mds = !study.plant.mds.empty();
  const bool random_steps = simulation.has("random_steps");
  if (!has_mds && random_steps) {
    simulation.refuse("random_steps", "steps of measured disturbances",
                      "none, because the plant has no measured disturbance");
  }
  if (!options.steps.empty() && random_steps) {
    simulation.refuse("", "both step of an MD and random_steps", "exactly one of the two");
  }
  if (simulation.has("excitation")) {
    const std::size_t choice = read_one_of(simulation, "excitation", {"none", "shared", "each"});
    if (choice == 0 && options.is_excited())
      simulation.refuse("excitation", "'none' beside steps, md_noise or dither", "one of the two");
    if (choice != 0 && !options.is_excited())
      simulation.refuse("excitation", "a choice without any signal",
                        "\"none\", or step, random_steps, limit_step, md_noise, dither");
    options.excitation = choice == 2 ? SignalSequence::each : SignalSequence::shared;
  } else if (!options.is_excited() && (has_mds || study.controller.has_setpoints())) {
    simulation.refuse("", "no excitation",
                      "step, random_steps, limit_step, md_noise, dither, or excitation = \"none\"");
  }
}

void sort_steps(SimulationOptions& options) {
  for (std::vector<SignalStep>* steps : {&options.steps, &options.setpoint_steps})
    std::sort(steps->begin(), steps->end(), [](const SignalStep& a, const SignalStep& b) {
      return std::tie(a.sample, a.variable) < std::tie(b.sample, b.variable);
    });
  std::sort(options.limit_steps.begin(), options.limit_steps.end(),
            [](const LimitStep& a, const LimitStep& b) {
              return std::tie(a.sample, a.cv) < std::tie(b.sample, b.cv);
            });
}

void refuse_large_record(const TomlTable& simulation, const Study& study) {
  const auto variables = static_cast<double>(study.cv_count() + study.mv_count() + study.md_count());
  if (variables * study.simulation.samples > kMostRecordNumbers)
    simulation.refuse("samples", fmt::format("{} of {} variables", study.simulation.samples, variables),
                      fmt::format("at most {} with this plant", std::floor(kMostRecordNumbers / variables)));
}

OptionKeys simulation_keys(Study& study) {
  SimulationOptions& options = study.simulation;
  const auto read_noise = [&study](const TomlTable& table, const std::string& key) {
    study.simulation.noise_standard_deviation =
        read_deviations(table, key, "CV", variable_names(study.plant.cvs));
  };
  const auto refuse_steps = [&study](const TomlTable& table) {
    if (table.has("step") && study.plant.mds.empty() && setpoint_cvs(study.controller).empty())
      table.refuse("step", "steps of measured disturbances or setpoints", "none, because there are neither");
  };
  const auto refuse_md_noise = [&study](const TomlTable& table) {
    if (table.has("md_noise") && study.plant.mds.empty())
      table.refuse("md_noise", "variation of measured disturbances",
                   "none, because the plant has no measured disturbance");
  };
  return {
      key::whole("samples", options.samples, 1, kMaxSamples, "length of the record", "samples")
          .required()
          .also("at least the longest moving window + 20; at most 5e7 over the variables of the plant"),
      key::check([&study](const TomlTable& table) { refuse_large_record(table, study); }),
      key::option("noise_standard_deviation", "number, or table",
                  "standard deviation of the measurement noise: one number for all CVs, or `{y1 = 0.01, y2 = "
                  "0.02}` with every CV",
                  "CV")
          .required()
          .allow(">= 0")
          .read(read_noise),
      key::optional_table(
          "noise", [&options] { return noise_keys(options.noise); },
          "distribution, colour and size of the noise")
          .otherwise("white, normal, of the same size in every experiment"),
      key::option(
          "excitation", "text",
          "whether loops share the signals below. `\"shared\"`: all loops, also the benchmark, have the same "
          "signals. `\"each\"`: every loop has its own. Random steps and variations are drawn anew; listed "
          "steps come at other times and in another order, and those of MDs and setpoints have half to all "
          "of the listed size. `\"none\"`: only noise and faults move the loop")
          .otherwise("`\"shared\"` with any excitation")
          .allow("`\"none\"` without anything that excites; `\"shared\"`, `\"each\"`"),
      key::list<SignalStep>(
          "step", kMaxSteps, [&options](SignalStep& step) { return step_keys(step, options.samples); },
          [&study](const TomlTable& table, SignalStep& step) { take_step(table, step, study); },
          "the steps of setpoints and measured disturbances, the same in every experiment")
          .allow("one or more")
          .after(refuse_steps),
      key::optional_table(
          "random_steps", [&options] { return random_steps_keys(options); },
          "steps of the measured disturbances drawn once for the study, the same in every experiment"),
      key::list<ListedLimits>(
          "limit_step", kMaxSteps, [&study](ListedLimits& step) { return limit_step_keys(step, study); },
          [&study](const TomlTable& table, const ListedLimits& step) { take_limit_step(table, step, study); },
          "moves of soft limits, as an operator makes them; the controller knows each from its sample on")
          .allow("one or more"),
      key::optional_table(
          "md_noise", [&study] { return md_noise_keys(study); },
          "random variation of every measured disturbance, added to its steps and drawn once for the study")
          .after(refuse_md_noise),
      key::list<Dither>(
          "dither", kMaxSteps, [&study](Dither& dither) { return dither_keys(dither, study); },
          [&options](const TomlTable&, Dither& dither) { options.dither.push_back(dither); },
          "test signals that are added to the moves of MVs, the same under every seed; several signals of "
          "one MV add up")
          .allow("one or more"),
      key::list<OffSpell>(
          "off", kMaxSteps, [&study](OffSpell& spell) { return off_keys(spell, study); },
          [&study](const TomlTable& table, OffSpell& spell) { take_off(table, spell, study); },
          "MVs and CVs that are switched off for a while, in every experiment. Several tables of one MV, one "
          "after the other, are moves of its operator")
          .allow("one or more"),
      key::check([&study](const TomlTable& table) {
        sort_steps(study.simulation);
        sort_off(table, study);
        read_excitation(table, study);
      })};
}

}  // namespace

OptionKey simulation_key(Study& study) {
  return key::table(
             "simulation", [&study] { return simulation_keys(study); },
             "length, noise and excitation of every closed loop")
      .required();
}

}  // namespace mpm
