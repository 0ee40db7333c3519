#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/validation/benchmark_period.hpp"
#include "analysis/validation/study_forecast.hpp"
#include "analysis/validation/study_warnings.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What is implausible in a study, one slip at a time, and what its first experiments say of the others.

namespace mpm {
namespace {

using Catch::Contains;

/// The warnings of the study as one text, a line each.
std::string warnings_of(const Study& study) {
  std::string text;
  for (const StudyWarning& warning : study_warnings(study))
    text += to_string(warning) + "\n";
  return text;
}

TEST_CASE("a study as it should be has no warning, and each slip its own", "[validation]") {
  const Study good = find_study("false-alarms");
  CHECK(warnings_of(good) == "");
  struct Slip {
    void (*change)(Study&);
    std::string key, words;
  };
  const std::vector<Slip> slips{
      {[](Study& s) {
         s.plant.step_fits = {{0, 1, 0.005}, {1, 0, 0.031}};
       },
       "plant.channel[].step", "y2/u1 leaves up to 3.1 % of its coefficients"},
      {[](Study& s) { s.controller.sample_time *= 60; }, "controller.sample_time",
       "is above the time constant of"},
      {[](Study& s) { s.controller.sample_time = 30; }, "controller.sample_time",
       "is less than a sample of 30 min"},
      {[](Study& s) { s.controller.prediction_horizon = 20; }, "controller.prediction_horizon",
       "20 samples, 80 min, are shorter than the settling time of"},
      {[](Study& s) { s.simulation.samples = 120; }, "simulation.samples", "settling times of"},
      {[](Study& s) { s.simulation.noise_standard_deviation(1) = 0; }, "simulation.noise_standard_deviation",
       "0 for y2"},
      {[](Study& s) { s.simulation.noise_standard_deviation(1) *= 10; },
       "simulation.noise_standard_deviation", "for y2 is 10 % of the width of its soft range"},
      {[](Study& s) { s.controller.cv_soft.lower(0) = s.controller.cv_soft.upper(0) = 1e3; },
       "controller.cv.y1.soft", "within their hard limits the MVs can only bring y1 to"},
      {[](Study& s) {
         s.simulation.limit_steps = {{0, 9, -1e3, -1e3}};
       },
       "simulation.limit_step", "check the signs"},
      {[](Study& s) { s.simulation.steps.clear(); }, "diagnosis.self_check", "without excitation"},
      {[](Study& s) { s.experiments.healthy = s.experiments.tuning = 0; }, "experiments.healthy",
       "no false alarm"},
  };
  for (const Slip& slip : slips) {
    Study study = good;
    slip.change(study);
    INFO(slip.key << ": " << slip.words);
    CHECK_THAT(warnings_of(study), Contains(slip.words));
    const std::vector<StudyWarning> warnings = study_warnings(study);
    CHECK(std::any_of(warnings.begin(), warnings.end(),
                      [&](const StudyWarning& warning) { return warning.key == slip.key; }));
  }
}

TEST_CASE("setpoints are held against hard limits, and against what the MVs can do", "[validation]") {
  Study study = find_study("setpoint-methods");
  CHECK_THAT(warnings_of(study), !Contains("simulation.step"));
  study.controller.cv_hard.upper(0) = 1.0;
  CHECK_THAT(warnings_of(study), Contains("simulation.step: 1.25 for y1 is outside its hard limits"));
  study = find_study("setpoint-methods");
  study.controller.mv_hard.lower.setZero();  // all gains are positive: nothing brings a CV below 0
  CHECK_THAT(warnings_of(study),
             Contains("simulation.step: [-1.25, -1.25]") && Contains("signs of the gains"));
  study.simulation.setpoint_steps.clear();
  study.simulation.initial_setpoint(2) = -0.5;
  CHECK_THAT(warnings_of(study), Contains("controller.cv.y3.setpoint: [-0.5, -0.5]"));
}

TEST_CASE("the basis case: the edge of the self-check, noise, and MVs at their limits", "[validation]") {
  const Study study = find_study("false-alarms");
  const Eigen::Index ny = study.cv_count(), nu = study.mv_count();
  BasisCase basis;
  basis.healthy = true;
  basis.diagnosis.ivar = Eigen::VectorXd::Constant(ny, 1.02);
  basis.trajectory.y = Eigen::MatrixXd::Random(ny, 200);
  basis.trajectory.u = Eigen::MatrixXd::Zero(nu, 200);
  CHECK(basis_warnings(study, basis).empty());

  basis.diagnosis.ivar(3) = 1.17;
  basis.trajectory.y.row(1) *= 0.005;  // noise of 0.005
  basis.trajectory.u.row(1).head(30).setConstant(study.controller.mv_hard.upper(1));
  const std::vector<StudyWarning> warnings = basis_warnings(study, basis);
  REQUIRE(warnings.size() == 3);
  CHECK_THAT(to_string(warnings[0]), Contains("self_check_band: Ivar of the basis case is 1.170 for y4"));
  CHECK_THAT(to_string(warnings[1]), Contains("of the variance of y2 in the basis case"));
  CHECK_THAT(to_string(warnings[2]), Contains("controller.mv.u2.hard: at a limit in 15 % of the basis case"));

  basis.healthy = false;
  basis.explanation = "Ivar is 7";
  CHECK_THAT(to_string(basis_warnings(study, basis).front()),
             Contains("Ivar is 7; a run refuses such a study"));
}

/// An experiment that ran to its end; the fault, if there is one, multiplies the variance of each CV.
ExperimentRecord made_up(const Study& study, ExperimentKind kind, double ivar_basis) {
  ExperimentRecord record;
  record.draw.kind = kind;
  record.status = ExperimentStatus::ok;
  record.ivar_basis = Eigen::VectorXd::Constant(study.cv_count(), ivar_basis);
  return record;
}

TEST_CASE("a pilot says how many loops with impact there will be, and how well rates over them will be known",
          "[validation]") {
  const Study study = find_study("false-alarms");
  std::vector<ExperimentRecord> pilot;
  for (int i = 0; i < 4; ++i)
    pilot.push_back(made_up(study, ExperimentKind::mpm, 1.5));
  for (int i = 0; i < 6; ++i)
    pilot.push_back(made_up(study, ExperimentKind::ud, 1.0));
  for (int i = 0; i < 5; ++i)
    pilot.push_back(made_up(study, ExperimentKind::healthy, 1.0));
  pilot.resize(20);
  for (std::size_t i = 15; i < 20; ++i)
    pilot[i].status = ExperimentStatus::infeasible;
  const StudyForecast found = forecast(study, pilot);
  const double scale = study.experiment_count() / 20.0;
  CHECK(found.feasible.hits == 15);
  CHECK(found.impact.hits == 4);
  CHECK(found.impact.total == 10);
  CHECK(found.loops_with_impact == Approx(4 * scale));
  CHECK(found.loops_without_fault == Approx(5 * scale));
  const auto loops = static_cast<std::int64_t>(4 * scale + 0.5);
  const Interval wilson = wilson_interval((loops + 1) / 2, loops);
  CHECK(found.detection_width == Approx(wilson.upper - wilson.lower).epsilon(0.02));
  CHECK(found.bytes_of_a_loop == (2 * 7 + 2 * 3 + 2) * 400 * 8);
  const std::vector<StudyWarning> warnings = forecast_warnings(study, found, pilot);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(to_string(warnings[0]), Contains("5 of 20 loops of the pilot do not run to their end"));

  // No fault has an impact, and every loop runs.
  std::vector<ExperimentRecord> mild(5, made_up(study, ExperimentKind::mpm, 1.1));
  CHECK_THAT(to_string(forecast_warnings(study, forecast(study, mild), mild).front()),
             Contains("none of the 5 faults of the pilot has an impact"));
  // None of five is not none of all: the share may be up to 43 % (Wilson, 95 %).
  const Interval possible = forecast(study, mild).loops_with_impact_interval;
  CHECK(possible.lower == Approx(0.0).margin(1e-9));
  CHECK(possible.upper == Approx(0.434 * study.experiment_count()).epsilon(0.01));
  Study small = study;
  small.experiments = {.mpm = 10, .healthy = 10};
  std::vector<ExperimentRecord> few(10, made_up(study, ExperimentKind::mpm, 1.5));
  CHECK_THAT(to_string(forecast_warnings(small, forecast(small, few), few).front()),
             Contains("about 20 loops with impact: a rate of 0.5 over them is known to +- 0.20"));
}

TEST_CASE("of a study in worlds a pilot says how well its worlds let rates be known", "[validation]") {
  Study study = find_study("false-alarms");
  study.experiments = {.mpm = 80, .healthy = 80};
  std::vector<ExperimentRecord> pilot(10, made_up(study, ExperimentKind::mpm, 1.5));
  pilot.resize(20, made_up(study, ExperimentKind::healthy, 1.0));
  const StudyForecast independent = forecast(study, pilot);
  CHECK(independent.worlds == 0);
  study.world = WorldRanges{.count = 8};
  for (ExperimentRecord& record : pilot) {
    record.cost.emplace();
    record.cost->variance_ratio = record.ivar_basis;
  }
  const StudyForecast found = forecast(study, pilot);
  CHECK(found.worlds == 8);
  // 80 loops in 8 worlds with a correlation of 0.3: 80 / 3.7 (1.960 / 2.365)^2 = 14.85 independent ones.
  const Interval expected = score_interval(0.5, 14.85, 0.95);
  CHECK(found.detection_width == Approx(expected.upper - expected.lower).epsilon(0.01));
  CHECK(found.detection_width > 1.5 * independent.detection_width);
  // Ever more loops: 8 / 0.3 (1.960 / 2.365)^2 = 18.3.
  const Interval best = score_interval(0.5, 18.3, 0.95);
  CHECK(found.detection_width_limit == Approx(best.upper - best.lower).epsilon(0.01));
  CHECK_THAT(to_string(forecast_warnings(study, found, pilot).front()),
             Contains("the 8 worlds are the limit") && Contains("world.count"));
  study.world->count = 100;
  CHECK(forecast(study, pilot).detection_width < 1.1 * independent.detection_width);
}

TEST_CASE("a world whose loop is not stable is warned of", "[validation]") {
  Study study = find_study("suite-ogunnaike-ray");
  study.world = WorldRanges{.count = 2};
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const auto found = [&] {
    std::string all;
    for (const StudyWarning& warning : basis_warnings(study, basis))
      all += to_string(warning) + "\n";
    return all;
  };
  CHECK_THAT(found(), !Contains("unstable"));
  study.world->gain_factor = Distribution::constant(8.0);
  CHECK_THAT(found(), Contains("2 of 2 worlds are unstable without a fault") && Contains("\"exclude\""));
  study.diagnosis.unstable = UnstableLoops::exclude;
  CHECK_THAT(found(), Contains("the study leaves their experiments out"));
}

/// Simulation errors of two CVs over 300 samples, white with these deviations in three thirds.
Eigen::MatrixXd errors_in_thirds(const Eigen::Matrix<double, 2, 3>& deviations) {
  Eigen::MatrixXd errors(2, 300);
  RandomStream stream(20261122, 0, StreamId::measurement_noise);
  for (Eigen::Index k = 0; k < 300; ++k)
    for (Eigen::Index cv = 0; cv < 2; ++cv)
      errors(cv, k) = deviations(cv, k / 100) * stream.normal();
  return errors;
}

const Eigen::MatrixXd kNoInputs(0, 300);  // inputs

TEST_CASE("the quietest period is where the model is best, whatever the units", "[validation]") {
  const Eigen::Matrix<double, 2, 3> deviations{{3.0, 1.0, 2.0}, {30.0, 20.0, 60.0}};
  Eigen::MatrixXd errors = errors_in_thirds(deviations);
  const auto [first, end] = quietest_period(errors, kNoInputs, 80);
  CHECK(end - first == 80);
  CHECK(first >= 90);
  CHECK(end <= 210);
  // Where an input stands still that moves elsewhere, nothing is learnt of its channels; one that never moves
  // excludes no period.
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(2, 300);
  CHECK(quietest_period(errors, inputs, 80) == std::pair(first, end));
  inputs.row(1).tail(50).setOnes();
  const auto moved = quietest_period(errors, inputs, 80);
  CHECK((moved.first < 250 && moved.second > 250));
  // A constant error costs nothing, another unit neither.
  errors.row(0).array() += 100.0;
  errors.row(1) *= 1000.0;
  CHECK(quietest_period(errors, kNoInputs, 80) == std::pair(first, end));
  // A CV counts only where half of it is there.
  errors.row(1).setConstant(kNaN);
  CHECK(quietest_period(errors, kNoInputs, 80).first >= 90);
  errors.row(0).segment(90, 120).setConstant(kNaN);
  CHECK(quietest_period(errors, kNoInputs, 80).first >= 170);
}

TEST_CASE("a record without enough samples has no quietest period", "[validation]") {
  Eigen::MatrixXd errors = errors_in_thirds(Eigen::Matrix<double, 2, 3>::Ones());
  CHECK(quietest_period(errors, kNoInputs, 301) == std::pair<Eigen::Index, Eigen::Index>(0, 0));
  errors.setConstant(kNaN);
  CHECK(quietest_period(errors, kNoInputs, 80) == std::pair<Eigen::Index, Eigen::Index>(0, 0));
}

}  // namespace
}  // namespace mpm
