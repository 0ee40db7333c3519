#include "analysis/study_files/study_template.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/study_files/study_file_keys.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/settling_time.hpp"
#include "scenarios/toml/toml_draft.hpp"

namespace mpm {
namespace {

constexpr const char* kHead =
    "# Written by `mpmbench init`. Variables are deviations from the operating point. The model, the limits "
    "and\n"
    "# the sizes are those that you gave; sample time, horizons, weights, noise, excitation and faults are "
    "first\n"
    "# guesses made from them: change what you know better. `mpmbench validate` finds implausible "
    "values.\n\n";

constexpr const char* kCostNote =
    "# To do: a guess that drives CVs with a range to their upper limits. Put in what the MV costs: its "
    "sign\n"
    "# says to which end the optimizer drives the MV, and can decide a verdict\n";

constexpr double kStepsOfFastest = 10.0;  // samples in the shortest channel, unless this gives ...
constexpr double kMostSamples = 150.0;    // ... more than this until the slowest channel has settled
constexpr double kSeenBehind = 3.0;       // dead times in the horizon, so that it shows the effect of an MV
constexpr double kNoise = 0.01;           // of the size of a CV

double rounded(double value) {
  return std::stod(fmt::format("{:.2g}", value));
}

/// The quantities from which a template is computed.
struct Guess {
  explicit Guess(const StudySketch& sketch);

  double shortest = kInfinity, longest = 0.0;  ///< sums of the time constants of a channel
  double settled = 0.0;                        ///< settling time of the slowest channel
  double dead_time = 0.0;                      ///< the largest
  double sample_time = 0.0;
  int prediction_horizon = 0, samples = 0;
  Eigen::VectorXd size;  ///< of each CV: that of its setpoint steps, or half of its range
  Eigen::MatrixXd gain;  ///< static, relative to these sizes
};

void require(const StudySketch& sketch) {
  const PlantModel& plant = sketch.plant;
  plant.validate();
  for (Eigen::Index cv = 0; cv < plant.G.rows(); ++cv) {
    const std::string& name = plant.cvs[static_cast<std::size_t>(cv)].name;
    if (const auto& range = sketch.ranges[static_cast<std::size_t>(cv)])
      if (!std::isfinite(range->first) || !std::isfinite(range->second) || !(range->first < range->second))
        throw InputError(fmt::format("range of {}", name),
                         fmt::format("{} to {}", range->first, range->second), "two numbers, low < high");
    if (!(std::isfinite(sketch.size(cv)) && sketch.size(cv) > 0))
      throw InputError(fmt::format("setpoint of {}", name), fmt::format("{}", sketch.size(cv)),
                       "a size > 0 by which it moves");
  }
  if (sketch.sample_time && !(std::isfinite(*sketch.sample_time) && *sketch.sample_time > 0))
    throw InputError("sample time", fmt::format("{}", *sketch.sample_time), "a number > 0");
  bool moves = false;
  for (std::size_t mv = 0; mv < plant.mvs.size(); ++mv)
    for (Eigen::Index cv = 0; cv < plant.G.rows(); ++cv)
      moves = moves || !plant.G(cv, static_cast<Eigen::Index>(mv)).is_zero();
  if (!moves)
    throw InputError("channels", "none from an MV", "one or more from an MV to a CV");
}

Guess::Guess(const StudySketch& sketch) : size(sketch.size), gain(sketch.plant.G.steady_gain()) {
  const TransferMatrix& G = sketch.plant.G;
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv) {
    if (const auto& range = sketch.ranges[static_cast<std::size_t>(cv)])
      size(cv) = (range->second - range->first) / 2.0;
    gain.row(cv) /= size(cv);
    for (Eigen::Index input = 0; input < G.cols(); ++input) {
      const TransferFunction& channel = G(cv, input);
      if (channel.is_zero())
        continue;
      const double residence = sum_of_time_constants(channel);
      longest = std::max(longest, residence);
      if (residence > 0)
        shortest = std::min(shortest, residence);
      settled = std::max(settled, settling_time(channel));
      dead_time = std::max(dead_time, channel.dead_time());
    }
  }
  if (shortest == kInfinity)  // only gains and dead times
    shortest = longest = settled = std::max(dead_time, 1.0);
  settled = std::max(settled, kSeenBehind * dead_time);
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
    if (G.is_integrating(cv))  // its move until the others have settled
      gain.row(cv) *= settled;
  sample_time =
      sketch.sample_time.value_or(rounded(std::max(shortest / kStepsOfFastest, settled / kMostSamples)));
  prediction_horizon = static_cast<int>(std::clamp(std::ceil(settled / sample_time), 10.0, 300.0));
  samples = std::max(400, 10 * prediction_horizon);
}

std::string channel_name(const PlantModel& plant, Eigen::Index input) {
  const auto place = static_cast<std::size_t>(input);
  return place < plant.mvs.size() ? plant.mvs[place].name : plant.mds[place - plant.mvs.size()].name;
}

TomlDraft& below(TomlDraft& parent, std::string_view key, std::string_view table) {
  const OptionKeys& keys = study_file_keys(table);
  return parent.table(key, key_names(keys)).explain(table, plain_meanings(keys));
}

TomlDraft& entry_of(TomlDraft& parent, std::string_view list, std::size_t place, std::string_view table) {
  const OptionKeys& keys = study_file_keys(table);
  return parent.table_in_list(list, place, key_names(keys)).explain(table, plain_meanings(keys));
}

void write_variables(TomlDraft& plant, const std::string& group,
                     const std::vector<PlantModel::Variable>& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    TomlDraft& variable = entry_of(plant, group, i, fmt::format("plant.{}[]", group));
    variable.set("name", list[i].name);
    variable.set("unit", list[i].unit);
  }
}

void write_plant(TomlDraft& document, const PlantModel& plant) {
  TomlDraft& table = below(document, "plant", "plant");
  table.set("name", plant.name);
  table.set("title", plant.title);
  table.set("time_unit", plant.time_unit);
  write_variables(table, "cv", plant.cvs);
  write_variables(table, "mv", plant.mvs);
  write_variables(table, "md", plant.mds);
  std::size_t place = 0;
  for (Eigen::Index cv = 0; cv < plant.G.rows(); ++cv)
    for (Eigen::Index input = 0; input < plant.G.cols(); ++input) {
      const TransferFunction& G = plant.G(cv, input);
      if (G.is_zero())
        continue;
      TomlDraft& channel = entry_of(table, "channel", place++, "plant.channel[]");
      channel.set("cv", plant.cvs[static_cast<std::size_t>(cv)].name);
      channel.set("input", channel_name(plant, input));
      if (const auto& S = G.step_coefficients()) {
        channel.set("step", S->sampled(S->interval()));
        channel.set("step_interval", S->interval());
        continue;
      }
      if (G.order() == 1 && G.is_integrating()) {
        channel.set("rate_gain", G.rate_gain());
      } else if (G.order() == 1 && G.numerator().size() == 1 && G.denominator()(0) > 0) {
        channel.set("gain", G.static_gain());
        channel.set("time_constant", G.residence_time());
      } else {
        channel.set("numerator", G.numerator());
        channel.set("denominator", G.denominator());
      }
      if (G.dead_time() > 0)
        channel.set("dead_time", G.dead_time());
    }
}

/// Writes the MVs. Their costs drive every CV that has a range and does not integrate to its upper limit. The
/// costs lie in the row space of the gains, so that the optimum is bounded whatever the limits of the MVs.
void write_mvs(TomlDraft& controller, const StudySketch& sketch, const Guess& guess) {
  const bool ranges = std::any_of(sketch.ranges.begin(), sketch.ranges.end(),
                                  [](const auto& range) { return range.has_value(); });
  std::vector<std::string> names;
  for (const PlantModel::Variable& mv : sketch.plant.mvs)
    names.push_back(mv.name);
  TomlDraft& mvs = controller.table("mv", names);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const double effect = guess.gain.col(column).squaredNorm();
    const double weight = rounded(effect > 0 ? effect : 1.0);
    TomlDraft& mv = below(mvs, names[j], "controller.mv.NAME");
    if (ranges) {
      double cost = 0.0;
      for (std::size_t cv = 0; cv < sketch.ranges.size(); ++cv)
        if (sketch.ranges[cv] && !sketch.plant.G.is_integrating(static_cast<Eigen::Index>(cv)))
          cost -= guess.gain(static_cast<Eigen::Index>(cv), column);
      if (cost == 0.0 && sketch.plant.G.is_integrating()) {  // no range has a limit to which to drive the MV
        mv.set("resting_value", 0.0);
        mv.set("resting_weight", weight);
      } else {
        mv.set("cost", cost);
      }
      mv.set("target_weight", rounded(0.1 * weight));
    }
    mv.set("move_suppression", weight);
    mv.set("hard", std::pair(sketch.mv_hard.lower(column), sketch.mv_hard.upper(column)));
  }
}

void write_cvs(TomlDraft& controller, const StudySketch& sketch, const Guess& guess) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& cv : sketch.plant.cvs)
    names.push_back(cv.name);
  TomlDraft& cvs = controller.table("cv", names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double size = guess.size(static_cast<Eigen::Index>(i));
    TomlDraft& cv = below(cvs, names[i], "controller.cv.NAME");
    if (const auto& range = sketch.ranges[i]) {
      cv.set("slack_weight", rounded(10.0 / (size * size)));
      cv.set("soft", *range);
    } else {
      cv.set("setpoint_weight", rounded(1.0 / (size * size)));
      cv.set("setpoint", 0.0);
    }
    cv.set("hard", std::pair(-kInfinity, kInfinity));
  }
}

void write_controller(TomlDraft& document, const StudySketch& sketch, const Guess& guess) {
  TomlDraft& controller = below(document, "controller", "controller");
  controller.set("sample_time", guess.sample_time);
  controller.set("prediction_horizon", guess.prediction_horizon);
  controller.set("control_horizon", std::clamp(guess.prediction_horizon / 5, 2, 10));
  write_mvs(controller, sketch, guess);
  write_cvs(controller, sketch, guess);
}

/// Writes moves of one CV after the other. A setpoint goes up and down in turn; a range is narrowed by a
/// quarter from above, and widened again.
void write_moves(TomlDraft& simulation, const StudySketch& sketch, const Guess& guess) {
  constexpr int kMoves = 8;
  std::size_t steps = 0, limit_steps = 0;
  std::vector<double> level(sketch.ranges.size(), 0.0);
  for (int move = 0; move < kMoves; ++move) {
    const std::size_t cv = static_cast<std::size_t>(move) % sketch.ranges.size();
    const int turn = move / static_cast<int>(sketch.ranges.size());
    const int sample = guess.samples * (2 * move + 1) / (2 * kMoves);
    const std::string& name = sketch.plant.cvs[cv].name;
    if (const auto& range = sketch.ranges[cv]) {
      const double cut = turn % 2 == 0 ? 0.25 * (range->second - range->first) : 0.0;
      TomlDraft& step = entry_of(simulation, "limit_step", limit_steps++, "simulation.limit_step[]");
      step.set("cv", name);
      step.set("sample", sample);
      step.set("soft", std::pair(range->first, range->second - cut));
    } else {
      level[cv] = level[cv] > 0 ? -guess.size(static_cast<Eigen::Index>(cv))
                                : guess.size(static_cast<Eigen::Index>(cv));
      TomlDraft& step = entry_of(simulation, "step", steps++, "simulation.step[]");
      step.set("cv", name);
      step.set("sample", sample);
      step.set("level", level[cv]);
    }
  }
}

void write_simulation(TomlDraft& document, const StudySketch& sketch, const Guess& guess) {
  const PlantModel& plant = sketch.plant;
  TomlDraft& simulation = below(document, "simulation", "simulation");
  simulation.set("samples", guess.samples);
  std::vector<std::string> names;
  for (const PlantModel::Variable& cv : plant.cvs)
    names.push_back(cv.name);
  TomlDraft& noise = simulation.table("noise_standard_deviation", names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double known = i < sketch.noise.size() ? sketch.noise[i] : 0.0;
    noise.set(names[i], rounded(known > 0 ? known : kNoise * guess.size(static_cast<Eigen::Index>(i))));
  }
  write_moves(simulation, sketch, guess);
  if (plant.mds.empty())
    return;
  // The effect of an MD on a CV is at most half of the size of the CV.
  const double effect =
      guess.gain.rightCols(static_cast<Eigen::Index>(plant.mds.size())).cwiseAbs().maxCoeff();
  const double level = rounded(effect > 0 ? 0.5 / effect : 1.0);
  TomlDraft& steps = below(simulation, "random_steps", "simulation.random_steps");
  steps.set("interval", Distribution::uniform(std::round(0.7 * guess.prediction_horizon),
                                              std::round(1.3 * guess.prediction_horizon)));
  steps.set("level", Distribution::uniform(-level, level));
}

/// Writes faults with all sizes of effect for any plant: pilot loops find the sizes of the faults.
void write_faults(TomlDraft& document, const Guess& guess) {
  TomlDraft& experiments = below(document, "experiments", "experiments");
  for (const char* kind : {"mpm", "ud", "healthy"})
    experiments.set(kind, 20);
  experiments.set("mpm_ud", 10);
  const Distribution impact = Distribution::log_uniform(0.1, 5.0);
  const double shift = rounded(std::max(guess.sample_time, 0.5 * guess.dead_time));
  TomlDraft& mismatch = below(document, "mismatch", "mismatch");
  mismatch.set("dead_time_shift", Distribution::uniform(-shift, shift));
  mismatch.set("impact", impact);
  const double size = guess.size.minCoeff();
  TomlDraft& disturbance = below(document, "disturbance", "disturbance");
  disturbance.set("gain", Distribution::uniform(rounded(0.1 * size), rounded(size)));
  disturbance.set("time_constant",
                  Distribution::uniform(rounded(guess.longest), rounded(5.0 * guess.longest)));
  disturbance.set("impact", impact);
}

void write_analysis(TomlDraft& document, const StudySketch& sketch, const Guess& guess) {
  TomlDraft& sensitivity = below(document, "sensitivity", "sensitivity");
  std::vector<std::string> levels;  // with levels alone, no CV comes to rest at a limit
  for (std::size_t cv = 0; cv < sketch.ranges.size(); ++cv)
    if (sketch.ranges[cv] && sketch.plant.G.is_integrating(static_cast<Eigen::Index>(cv)))
      levels.push_back(sketch.plant.cvs[cv].name);
  if (levels.size() == sketch.ranges.size()) {
    levels.resize(std::min(levels.size(), sketch.plant.mvs.size()));
    sensitivity.set("active_cvs", levels);
  }
  sensitivity.set("samples", std::max(100, 3 * guess.prediction_horizon));
  sensitivity.set("step_size", rounded(0.1 * guess.size.minCoeff()));
  below(document, "methods", "methods").set("names", std::vector<std::string>{"botelho", "mpmbench"});
}

/// Adds a note to each cost that it is a guess.
std::string with_cost_notes(std::string text) {
  constexpr std::string_view kCost = "\ncost = ";
  for (std::size_t at = text.find(kCost); at != std::string::npos; at = text.find(kCost, at)) {
    text.insert(at + 1, kCostNote);
    at += std::string_view(kCostNote).size() + 1;
  }
  return text;
}

}  // namespace

std::string study_template(const StudySketch& sketch) {
  require(sketch);
  const Guess guess(sketch);
  TomlDraft document(key_names(study_file_keys("")));
  document.explain("", plain_meanings(study_file_keys("")));
  TomlDraft& heading = below(document, "study", "study");
  heading.set("name", sketch.plant.name);
  heading.set("title", fmt::format("{}: random mismatches and disturbances", sketch.plant.title));
  heading.set("seed", 1);
  write_plant(document, sketch.plant);
  write_controller(document, sketch, guess);
  write_simulation(document, sketch, guess);
  write_faults(document, guess);
  write_analysis(document, sketch, guess);
  return kHead + with_cost_notes(document.text());
}

}  // namespace mpm
