#include "analysis/study_files/recorded_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "analysis/study_files/study_variant.hpp"
#include "base/error.hpp"
#include "plants/analyser.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostRecordedMoves = 10000;
constexpr double kFirstTolerance = 0.01;  // in standard deviations of an MD
constexpr double kFewestMissing = 0.001;
constexpr double kMostBackground = 0.75;     // standard deviations of the noise
constexpr double kLongestBackground = 20.0;  // samples
constexpr std::string_view kTrialTitle = "Calibration run: ";

/// Returns the table under `key`, which is created if it does not exist.
toml::table& table_in(toml::table& owner, std::string_view key) {
  return *owner.insert(key, toml::table()).first->second.as_table();
}

const std::string& name_at(const std::vector<PlantModel::Variable>& variables, Eigen::Index i) {
  return variables[static_cast<std::size_t>(i)].name;
}

/// Returns the samples at which a signal is no longer within `tolerance` of its value at the last move.
std::vector<Eigen::Index> moves_of(const Eigen::RowVectorXd& signal, double start, double tolerance) {
  std::vector<Eigen::Index> moves;
  double level = start;
  for (Eigen::Index k = 0; k < signal.size(); ++k)
    if (std::abs(signal(k) - level) > tolerance) {
      moves.push_back(k);
      level = signal(k);
    }
  return moves;
}

void add_md_steps(const Study& study, const Eigen::MatrixXd& d, toml::array& steps) {
  const Eigen::VectorXd deviations =
      ((d.colwise() - d.rowwise().mean()).rowwise().squaredNorm() / static_cast<double>(d.cols()))
          .cwiseSqrt();
  std::vector<std::vector<Eigen::Index>> moves(static_cast<std::size_t>(d.rows()));
  for (double tolerance = 0.0;; tolerance = std::max(kFirstTolerance, 2.0 * tolerance)) {
    std::size_t count = 0;
    for (Eigen::Index md = 0; md < d.rows(); ++md) {
      auto& of_md = moves[static_cast<std::size_t>(md)];
      of_md = moves_of(d.row(md), 0.0, tolerance * deviations(md));
      count += of_md.size();
    }
    if (count <= kMostRecordedMoves)
      break;
  }
  for (Eigen::Index md = 0; md < d.rows(); ++md)
    for (const Eigen::Index k : moves[static_cast<std::size_t>(md)])
      steps.push_back(toml::table{{"md", name_at(study.plant.mds, md)}, {"sample", k}, {"level", d(md, k)}});
}

/// Adds the recorded setpoints: the first value becomes the setpoint of the controller, later changes become
/// steps.
void add_setpoints(const Study& study, const Eigen::MatrixXd& y_set, toml::table& text, toml::array& steps) {
  for (Eigen::Index cv = 0; cv < y_set.rows(); ++cv) {
    if (!study.controller.has_setpoint(cv) || std::isnan(y_set(cv, 0)))
      continue;
    const std::string& name = name_at(study.plant.cvs, cv);
    table_in(table_in(table_in(text, "controller"), "cv"), name).insert_or_assign("setpoint", y_set(cv, 0));
    for (const Eigen::Index k : moves_of(y_set.row(cv), y_set(cv, 0), 0.0))
      steps.push_back(toml::table{{"cv", name}, {"sample", k}, {"level", y_set(cv, k)}});
  }
}

toml::array limit_steps(const Study& study, const PlantRecord& record) {
  toml::array steps;
  for (Eigen::Index cv = 0; cv < record.lower.rows(); ++cv) {
    if (std::isnan(record.lower(cv, 0)) && std::isnan(record.upper(cv, 0)))
      continue;
    const auto at = [cv](const Eigen::MatrixXd& recorded, double of_study, Eigen::Index k) {
      return std::isnan(recorded(cv, k)) ? of_study : recorded(cv, k);
    };
    std::pair in_force{study.controller.cv_soft.lower(cv), study.controller.cv_soft.upper(cv)};
    const auto [lower, upper] = in_force;
    for (Eigen::Index k = 0; k < record.samples(); ++k) {
      const std::pair limits{at(record.lower, lower, k), at(record.upper, upper, k)};
      if (limits != in_force)
        steps.push_back(toml::table{{"cv", name_at(study.plant.cvs, cv)},
                                    {"sample", k},
                                    {"soft", toml::array{limits.first, limits.second}}});
      in_force = limits;
    }
  }
  return steps;
}

/// Returns a table for each period in which a variable is off. A move of an MV that is off starts a new
/// table.
toml::array off_spells(const Study& study, const PlantRecord& record) {
  toml::array spells;
  const auto add = [&](const char* sort, const std::string& name, Eigen::Index begin, Eigen::Index end) {
    spells.push_back(toml::table{{sort, name}, {"sample", begin}, {"samples", end - begin}});
  };
  for (Eigen::Index mv = 0; mv < record.u_off.rows(); ++mv)
    for (Eigen::Index k = 0, end = 0; k < record.samples(); k = std::max(end, k + 1)) {
      for (end = k;
           end < record.samples() && record.has_mv_off(mv, end) && record.u(mv, end) == record.u(mv, k);)
        ++end;
      if (end == k)
        continue;
      add("mv", name_at(study.plant.mvs, mv), k, end);
      spells.back().as_table()->insert("level", record.u(mv, k));
    }
  for (Eigen::Index cv = 0; cv < record.y_off.rows(); ++cv)
    for (Eigen::Index k = 0, end = 0; k < record.samples(); k = std::max(end, k + 1)) {
      for (end = k; end < record.samples() && record.has_cv_off(cv, end);)
        ++end;
      if (end > k)
        add("cv", name_at(study.plant.cvs, cv), k, end);
    }
  return spells;
}

const char* word_of(GapFill fill) {
  switch (fill) {
    case GapFill::none:
      return "none";
    case GapFill::hold:
      return "hold";
    case GapFill::linear:
      return "linear";
  }
  return "none";
}

/// Returns the share of the samples of the CVs that are missing, and the mean length of a gap.
toml::table missing_of(const Eigen::MatrixXd& y, GapFill fill) {
  double missing = 0.0, gaps = 0.0;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    for (Eigen::Index k = 0; k < y.cols(); ++k)
      if (std::isnan(y(cv, k))) {
        missing += 1.0;
        gaps += k == 0 || !std::isnan(y(cv, k - 1)) ? 1.0 : 0.0;
      }
  const double length = missing / std::max(gaps, 1.0);
  return toml::table{
      {"share", std::min(missing / static_cast<double>(y.size()), 0.99 * length / (length + 1.0))},
      {"length", length},
      {"fill", word_of(fill)}};
}

toml::table spread(double low, double high) {
  return toml::table{{"uniform", toml::array{low, high}}};
}

/// Returns a world for every loop of a kind. Uniform errors with the standard deviation e range from -e sqrt
/// 3 to e sqrt 3.
toml::table imperfect_worlds(const Study& study, const TrialPlan& plan) {
  // The gain of a repair is of no interest for a simulated record, so no loops are spent on it.
  toml::table world{
      {"count", std::max({1, plan.healthy, plan.faulty})}, {"cost_loops", 1}, {"repair_loops", 0}};
  if (!study.nonlinear)
    for (const char* key : {"gain_factor", "time_constant_factor", "dead_time_factor"})
      world.insert(key,
                   spread(1.0 - std::sqrt(3.0) * plan.model_error, 1.0 + std::sqrt(3.0) * plan.model_error));
  if ((study.simulation.noise_standard_deviation.array() > 0.0).all())
    world.insert("background", toml::table{{"cv_size", spread(0.0, kMostBackground)},
                                           {"time_constant", spread(1.0, kLongestBackground)}});
  return world;
}

void refuse_short_record(const Study& study, const PlantRecord& record) {
  const Eigen::Index fewest = window_scan(study).longest + kFewestCorrelatedPairs;
  if (record.samples() < fewest)
    throw InputError("record", fmt::format("{} samples of the controller", record.samples()),
                     fmt::format("{} and more, of {:g} {} each: a longer period", fewest,
                                 study.controller.sample_time, study.plant.time_unit));
}

}  // namespace

Study recorded_study(const Study& study, const PlantRecord& record, const std::vector<std::string>& methods,
                     const std::optional<MonitoringOptions>& monitoring) {
  refuse_short_record(study, record);
  const std::string name = fmt::format("{} under the record", study.name);
  toml::table text = parse_toml(study.source, name);
  for (const char* key : {"data", "s0_perturbation", "calibration", "reference", "monitoring", "world"})
    text.erase(key);
  if (study.names_scenarios()) {
    text.erase("scenario");
    text.insert_or_assign("experiments", toml::table{{"mpm", 1}, {"ud", 1}, {"mpm_ud", 0}});
  }
  if (study.onset.sample.maximum() >= static_cast<double>(record.samples()))
    text.erase("onset");

  toml::table& simulation = table_in(text, "simulation");
  for (const char* key : {"step", "random_steps", "limit_step", "md_noise", "excitation", "dither", "off"})
    simulation.erase(key);
  simulation.insert_or_assign("samples", record.samples());
  toml::array steps;
  add_md_steps(study, as_taken_in_record(study.controller.md_analysers, record.d), steps);
  add_setpoints(study, record.y_set, text, steps);
  toml::array limits = limit_steps(study, record);
  if (steps.empty() && limits.empty() && (study.md_count() > 0 || study.controller.has_setpoints()))
    simulation.insert_or_assign("excitation", "none");
  if (!steps.empty())
    simulation.insert_or_assign("step", std::move(steps));
  if (!limits.empty())
    simulation.insert_or_assign("limit_step", std::move(limits));
  if (toml::array off = off_spells(study, record); !off.empty())
    simulation.insert_or_assign("off", std::move(off));

  toml::table& historian = table_in(text, "record");
  historian.erase("missing");
  historian.erase("candidates");
  if (record.y.array().isNaN().cast<double>().mean() > kFewestMissing)
    historian.insert_or_assign("missing", missing_of(record.y, study.data.fill));
  if (record.candidates.rows() > 0)
    historian.insert_or_assign(
        "candidates", toml::table{{"count", std::min<Eigen::Index>(record.candidates.rows(),
                                                                   RecordOptions::kMostCandidates)}});
  table_in(text, "diagnosis").insert_or_assign("self_check", "none");
  if (monitoring)
    text.insert_or_assign("monitoring",
                          toml::table{{"window", monitoring->window}, {"stride", monitoring->stride}});
  toml::array names;
  for (const std::string& method : methods)
    names.push_back(method);
  text.insert_or_assign("methods", toml::table{{"names", std::move(names)}});
  return study_of(text, name, study.assessment.table);
}

Study with_analysers(const Study& study, const std::map<std::string, int>& periods) {
  toml::table text = parse_toml(study.source, study.name);
  for (const auto& [cv, period] : periods)
    table_in(table_in(table_in(text, "controller"), "cv"), cv).insert_or_assign("analyser_period", period);
  return study_of(text, study.name, study.assessment.table);
}

Study trial_study(const Study& recorded, const TrialPlan& plan) {
  toml::table text = parse_toml(recorded.source, recorded.name);
  const ExperimentCounts& counts = recorded.experiments;
  const int total = counts.mpm + counts.ud + counts.mpm_ud;
  const auto share = [&](int count) { return total == 0 ? plan.faulty / 2 : plan.faulty * count / total; };
  const int ud = share(counts.ud);
  const int mpm_ud = total == 0 ? 0 : share(counts.mpm_ud);
  text.insert_or_assign(
      "experiments",
      toml::table{
          {"mpm", plan.faulty - ud - mpm_ud}, {"ud", ud}, {"mpm_ud", mpm_ud}, {"healthy", plan.healthy}});
  text.erase("monitoring");
  text.erase("methods");  // methods change no loop
  table_in(text, "record").erase("missing");
  if (plan.model_error > 0.0)
    text.insert_or_assign("world", imperfect_worlds(recorded, plan));
  const std::uint64_t seed = (recorded.seed ^ kCalibrationBits) &
                             static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  table_in(text, "study").insert_or_assign("seed", static_cast<std::int64_t>(seed));
  table_in(text, "study")
      .insert_or_assign("title", fmt::format("{}{}{}{}", kTrialTitle, recorded.title,
                                             plan.judged.empty() ? "" : ", ", plan.judged));
  Study study = study_of(text, recorded.name + ", calibration run", recorded.assessment.table);
  study.methods = recorded.methods;
  return study;
}

bool is_trial_study(const Study& study) {
  return study.title.starts_with(kTrialTitle);
}

}  // namespace mpm
