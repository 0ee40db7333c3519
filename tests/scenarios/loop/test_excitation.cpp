#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/scenarios/study_texts.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Noise and excitation as they are, each by what defines it.

namespace mpm {
namespace {

constexpr int kLoopLength = 20000;

/// The small study, 20000 samples long, with these keys of [simulation].
Study excited_study(const std::string& keys) {
  const std::string text = testing::replaced(testing::small_study(), "samples = 60", "samples = 20000");
  return parse_study(testing::replaced(text, "[[simulation.step]]", keys + "\n[[simulation.step]]"),
                     "s.toml");
}

/// Of a signal with the mean 0, over its standard deviation; 3 for normal numbers.
double kurtosis(const Eigen::RowVectorXd& signal) {
  const double variance = signal.squaredNorm() / static_cast<double>(signal.size());
  return signal.array().pow(4).mean() / (variance * variance);
}

double autocorrelation(const Eigen::RowVectorXd& signal) {
  return signal.head(signal.size() - 1).dot(signal.tail(signal.size() - 1)) / signal.squaredNorm();
}

double deviation(const Eigen::RowVectorXd& signal) {
  return std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
}

TEST_CASE("measurement noise: a shared sequence is that of every loop but the repeated basis case",
          "[excitation]") {
  const Study each = excited_study("");
  const Study shared = excited_study("noise = {sequence = 'shared'}");
  const Eigen::MatrixXd noise = measurement_noise(shared, 0);
  CHECK(measurement_noise(shared, 4) == noise);
  CHECK(measurement_noise(shared, kBasisIndex) == noise);
  CHECK(measurement_noise(shared, kRepeatIndex) == measurement_noise(each, kRepeatIndex));
  for (const std::int64_t index : {kBasisIndex, kRepeatIndex, std::int64_t{0}, std::int64_t{4}})
    CHECK(measurement_noise(each, index) != noise);
  CHECK(measurement_noise(each, 4) != measurement_noise(each, 0));
  Study other = shared;
  ++other.seed;
  CHECK(measurement_noise(other, 0) != noise);
}

TEST_CASE("measurement noise: variance, tails and colour are those that are asked for", "[excitation]") {
  struct Case {
    std::string key;
    double lowest_kurtosis, highest_kurtosis, autocorrelation;
  };
  // Standard errors at 20000 samples: 0.035 of the kurtosis of normal numbers, some 0.3 of that of Laplace's
  // (6); Student's with 4 degrees of freedom has none, and in a record of this length it is far above 6.
  const std::vector<Case> cases{
      {"", 2.85, 3.15, 0.0},
      {"noise = {distribution = 'laplace'}", 5.0, 7.2, 0.0},
      {"noise = {distribution = 'student'}", 7.5, 1e4, 0.0},
      {"noise = {autocorrelation = 0.8}", 2.7, 3.3, 0.8},
      {"noise = {autocorrelation = -0.5}", 2.7, 3.3, -0.5},
  };
  for (const Case& expected : cases) {
    INFO(expected.key);
    const Eigen::MatrixXd noise = measurement_noise(excited_study(expected.key), 4);
    for (Eigen::Index cv = 0; cv < noise.rows(); ++cv) {
      // 0.5 % of a standard deviation for white normal numbers, four times as much with heavy tails or
      // colour.
      CHECK(deviation(noise.row(cv)) == Approx(0.01).epsilon(0.08));
      CHECK(kurtosis(noise.row(cv)) > expected.lowest_kurtosis);
      CHECK(kurtosis(noise.row(cv)) < expected.highest_kurtosis);
      CHECK(std::abs(autocorrelation(noise.row(cv)) - expected.autocorrelation) < 4 * 0.0071);
    }
  }
  // Each distribution takes the same quantiles: signs and ranks stay.
  const Eigen::MatrixXd normal = measurement_noise(excited_study(""), 4);
  const Eigen::MatrixXd student = measurement_noise(excited_study("noise = {distribution = 'student'}"), 4);
  CHECK((normal.array() * student.array() > 0).all());
  // F(1) of Student's t with 4 degrees of freedom is 0.81305; its standard deviation is sqrt(2).
  CHECK(static_cast<double>((student.array() < 0.01 / std::sqrt(2.0)).count()) / (2.0 * kLoopLength) ==
        Approx(0.81305).margin(4 * 0.0020));
}

TEST_CASE("the noise of an experiment has another size than that of the basis case", "[excitation]") {
  const Study study = excited_study("noise = {factor = {uniform = [2, 4]}}");
  const double first = draw_experiment(study, 0).noise_factor;
  CHECK((first >= 2 && first < 4));
  CHECK(draw_experiment(study, 1).noise_factor != first);
  CHECK(draw_experiment(study, 0).noise_factor == first);
  CHECK(basis_draw().noise_factor == 1);
  CHECK(draw_experiment(study, 0).mismatch_alone().noise_factor == first);

  Study chapter6 = find_study("chapter6");
  chapter6.simulation.samples = 40;
  ExperimentDraw draw;
  const Trajectory once = simulate_experiment(chapter6, draw, testing::kFactory);
  draw.noise_factor = 3;
  const Trajectory thrice = simulate_experiment(chapter6, draw, testing::kFactory);
  const Eigen::VectorXd noise = measurement_noise(chapter6, 0).col(0);  // before the first move acts
  CHECK((thrice.y.col(0) - once.y.col(0)).isApprox(2 * noise, 1e-9));
}

TEST_CASE("measured disturbances vary about their steps, the same in every experiment", "[excitation]") {
  const Eigen::MatrixXd steps = measured_disturbances(excited_study(""));
  const Study study = excited_study("md_noise = {standard_deviation = {drain = 0.2}, time_constant = 4}");
  const Eigen::RowVectorXd variation = (measured_disturbances(study) - steps).row(0);
  // Correlated over some 8 samples: 2500 independent ones.
  CHECK(deviation(variation) == Approx(0.2).epsilon(4 * 0.015));
  CHECK(autocorrelation(variation) == Approx(std::exp(-0.25)).margin(4 * 0.0045));
  const Eigen::MatrixXd white = measured_disturbances(excited_study("md_noise = {standard_deviation = 0.2}"));
  CHECK(std::abs(autocorrelation((white - steps).row(0))) < 4 * 0.0071);
}

TEST_CASE("a dither switches between two values, and may do so every few samples", "[excitation]") {
  const Study study = excited_study("dither = [{mv = 'cold', amplitude = 0.3, hold = 5}]");
  const Eigen::MatrixXd added = dither(study);
  CHECK(added.row(0).isZero(0));
  CHECK((added.row(1).array().abs() == 0.3).all());
  CHECK(std::abs(added.row(1).mean()) < 4 * 0.3 / std::sqrt(kLoopLength / 5.0));
  for (Eigen::Index k = 0; k < kLoopLength; ++k)
    if (k % 5 != 0 && added(1, k) != added(1, k - 1))
      FAIL("a new value at sample " << k);
  CHECK(dither(excited_study("")).size() == 0);
}

/// Chapter 6 at rest: no noise, no steps.
Study quiet_chapter6() {
  Study study = find_study("chapter6");
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.steps.clear();
  study.simulation.samples = 60;
  return study;
}

TEST_CASE("the controller knows the dither, which acts within the hard limits", "[excitation]") {
  Study study = quiet_chapter6();
  study.simulation.dither = {{0, 0.01, 3}, {1, 0.02, 1}};
  const Trajectory loop = simulate_experiment(study, basis_draw(), testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  // Model and plant agree and both have the MVs that act: the bias stays 0, and the targets where they are. A
  // controller that does not know the dither moves them by 0.005 and more.
  const double moved = (loop.u_target.colwise() - loop.u_target.col(0)).cwiseAbs().maxCoeff();
  CHECK(moved < 1e-6);
  CHECK((loop.u.row(1).tail(59) - loop.u.row(1).head(59)).cwiseAbs().maxCoeff() > 0.02);

  study.simulation.dither = {{0, 10, 3}};
  const Eigen::RowVectorXd u = simulate_experiment(study, basis_draw(), testing::kFactory).u.row(0);
  CHECK(u.minCoeff() == study.controller.mv_hard.lower(0));
  CHECK(u.maxCoeff() == study.controller.mv_hard.upper(0));
}

TEST_CASE("a soft limit that moves takes the CV that it holds with it, from its sample on", "[excitation]") {
  Study study = quiet_chapter6();
  study.simulation.samples = 200;
  const Trajectory still = simulate_experiment(study, basis_draw(), testing::kFactory);
  REQUIRE(still.status == ControlStatus::ok);
  // A CV that rests at its lower or upper soft limit; the new limit lies within the range.
  const Limits& soft = study.controller.cv_soft;
  Eigen::Index cv = 0;
  while (std::abs(still.y(cv, 0) - soft.upper(cv)) > 1e-6 && std::abs(still.y(cv, 0) - soft.lower(cv)) > 1e-6)
    REQUIRE(++cv < study.cv_count());
  const bool upper = std::abs(still.y(cv, 0) - soft.upper(cv)) < 1e-6;
  const double away = upper ? -0.1 : 0.1;
  study.simulation.limit_steps = {
      {cv, 20, soft.lower(cv) + (upper ? 0 : away), soft.upper(cv) + (upper ? away : 0)}};
  const Trajectory moved = simulate_experiment(study, basis_draw(), testing::kFactory);
  REQUIRE(moved.status == ControlStatus::ok);
  CHECK(moved.y.leftCols(20) == still.y.leftCols(20));
  CHECK(moved.u.leftCols(20) == still.u.leftCols(20));
  CHECK((moved.u.col(20) - still.u.col(20)).cwiseAbs().maxCoeff() > 1e-4);
  // A soft limit gives way a little to the other terms of the objective.
  CHECK(moved.y(cv, 199) - still.y(cv, 199) == Approx(away).epsilon(0.05));
  CHECK(soft_limits(study, 19) == soft);
  CHECK(soft_limits(study, 20).lower(cv) == study.simulation.limit_steps[0].lower);
}

TEST_CASE("wrong noise and wrong excitation are refused", "[excitation]") {
  const std::string noise = "noise_standard_deviation = 0.01";
  const auto with = [&](const std::string& key) { return noise + "\n" + key; };
  testing::check_refusals({
      {noise, with("noise = {distribution = 'cauchy'}"), "cauchy",
       "simulation.noise.distribution: found 'cauchy'; allowed: normal, student, laplace"},
      {noise, with("noise = {autocorrelation = 1}"), "autocorrelation",
       "simulation.noise.autocorrelation: found 1; allowed: a number in (-1, 1)"},
      {noise, with("noise = {factor = {normal = [1, 0.1]}}"), "factor",
       "simulation.noise.factor: found draws from -inf to inf; allowed: a distribution whose every draw is a "
       "number >= 0"},
      {noise, with("excitation = 'none'"), "excitation",
       "simulation.excitation: found 'none' beside steps, md_noise or dither; allowed: one of the two"},
      {noise, with("excitation = 'some'"), "excitation",
       "simulation.excitation: found 'some' (nearest: 'none'); allowed: none, shared, each"},
      {noise, with("limit_step = [{cv = 'level', sample = 60, soft = [0, 1]}]"), "limit_step",
       "simulation.limit_step[0].sample: found 60; allowed: a whole number from 0 to 59"},
      {noise, with("limit_step = [{cv = 'heat', sample = 6, soft = [0, 1]}]"), "limit_step",
       "simulation.limit_step[0].soft: found [0, 1]; allowed: limits where [-inf, 0.5] has them, within the "
       "hard "
       "ones [-inf, 3]"},
      {noise, with("limit_step = [{cv = 'level', sample = 6, soft = [0, 2.5]}]"), "limit_step",
       "simulation.limit_step[0].soft: found [0, 2.5]; allowed: limits where [0, 1] has them, within the "
       "hard "
       "ones [-2, 2]"},
      {noise, with("md_noise = {standard_deviation = -1}"), "md_noise",
       "simulation.md_noise.standard_deviation: found -1; allowed: a number >= 0"},
      {noise, with("dither = [{mv = 'drain', amplitude = 1}]"), "dither",
       "simulation.dither[0].mv: found 'drain'; allowed: hot, cold"},
      {noise, with("dither = [{mv = 'hot', amplitude = 0}]"), "dither",
       "simulation.dither[0].amplitude: found 0; allowed: a number > 0"},
  });
  const std::string text = testing::small_study();
  const std::string unexcited =
      text.substr(0, text.find("[[simulation.step]]")) + "%[experiments]\nmpm = 1\nud = 1\nmpm_ud = 0\n";
  CHECK_THAT(
      testing::refusal(testing::replaced(unexcited, "%", "")),
      Catch::Contains("simulation: found no excitation; allowed: step, random_steps, limit_step, md_noise, "
                      "dither, or excitation = \"none\""));
  for (const char* key : {"excitation = 'none'\n", "dither = [{mv = 'hot', amplitude = 0.1}]\n",
                          "md_noise = {standard_deviation = 0.1}\n",
                          "limit_step = [{cv = 'level', sample = 6, soft = [0.1, 1]}]\n"})
    CHECK(testing::refusal(testing::replaced(unexcited, "%", key)) == "accepted");
  // A side without a soft limit stays without one, whatever the hard limit is.
  CHECK(
      testing::refusal(testing::replaced(
          testing::replaced(unexcited, "%", "limit_step = [{cv = 'heat', sample = 6, soft = [-inf, 0.4]}]\n"),
          "hard = [-inf, 3]", "hard = [-3, 3]")) == "accepted");
}

}  // namespace
}  // namespace mpm
