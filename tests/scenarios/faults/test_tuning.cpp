#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/kind_sequence.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Chapter 6 with these counts and short loops.
Study short_study(const ExperimentCounts& counts) {
  Study study = find_study("chapter6");
  study.experiments = counts;
  study.simulation.samples = 60;
  return study;
}

const ExperimentCounts kAllKinds{.mpm = 3, .ud = 2, .mpm_ud = 1, .healthy = 4, .tuning = 5};

TEST_CASE("KindSequence: healthy experiments and bad tunings keep their proportions, too", "[tuning]") {
  const KindSequence sequence(kAllKinds);
  std::map<ExperimentKind, int> count;
  for (int i = 0; i < 150; ++i) {
    ++count[sequence[i]];
    for (const auto& [kind, number] : count)
      CHECK(std::abs(number - kAllKinds.of(kind) * (i + 1) / 15.0) <= 1.0);
  }
  CHECK(count.size() == 5);
}

TEST_CASE("KindSequence: without the new kinds the order is what it was", "[tuning]") {
  // The first kinds of chapter6 as the program drew them before there were others.
  const KindSequence sequence({150, 150, 100});
  const int before[] = {1, 2, 3, 1, 2, 3, 1, 2, 1, 2, 3, 1, 2, 3, 1, 2};
  for (std::int64_t i = 0; i < 16; ++i)
    CHECK(static_cast<int>(sequence[i]) == before[i]);
}

TEST_CASE("draw_experiment: nothing is wrong in a healthy experiment, one weight in a bad tuning",
          "[tuning]") {
  const Study study = short_study(kAllKinds);
  std::set<std::pair<TuningParameter, Eigen::Index>> changed;
  std::vector<double> logarithms;
  for (std::int64_t i = 0; i < 3000; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    CHECK(draw.tuning.has_value() == (draw.kind == ExperimentKind::tuning));
    if (!is_faultless(draw.kind))
      continue;
    CHECK((draw.mismatches.empty() && draw.disturbances.empty() && draw.parameters.empty()));
    CHECK(draw.affected().empty());
    CHECK(draw.true_cv() == -1);
    if (!draw.tuning)
      continue;
    changed.insert({draw.tuning->parameter, draw.tuning->index});
    CHECK((draw.tuning->factor >= 0.05 && draw.tuning->factor <= 20.0));
    logarithms.push_back(std::log(draw.tuning->factor));
  }
  // 3 MVs twice and 7 CVs once; each is missed with probability (20/21)^1000 at most. No CV has a setpoint.
  CHECK(changed.size() == 13);
  CHECK(std::none_of(changed.begin(), changed.end(),
                     [](const auto& entry) { return entry.first == TuningParameter::setpoint_weight; }));
  // The mean of 1000 logarithms, uniform on +-3, has a standard deviation of 0.055.
  double sum = 0.0;
  for (const double logarithm : logarithms)
    sum += logarithm;
  CHECK(std::abs(sum / static_cast<double>(logarithms.size())) < 0.25);
}

TEST_CASE("draw_experiment: other kinds beside them change no mismatch and no disturbance", "[tuning]") {
  const Study with = short_study(kAllKinds);
  const Study without = short_study({.mpm = 1});
  int compared = 0;
  for (std::int64_t i = 0; i < 60; ++i) {
    const ExperimentDraw draw = draw_experiment(with, i);
    if (draw.mismatches.empty())
      continue;
    ++compared;
    const Mismatch expected = draw_experiment(without, i).mismatches.front();
    CHECK(draw.mismatches.front().cv == expected.cv);
    CHECK(draw.mismatches.front().input == expected.input);
    CHECK(draw.mismatches.front().value == expected.value);
  }
  CHECK(compared == 16);  // 4 of 15
}

TEST_CASE("draw_experiment: parameters follow their weights", "[tuning]") {
  Study study = short_study({.tuning = 1});
  study.tuning.parameter_weight = {0.0, 3.0, 1.0, 100.0};  // the last: no CV has a setpoint
  std::map<TuningParameter, int> count;
  for (std::int64_t i = 0; i < 2000; ++i)
    ++count[draw_experiment(study, i).tuning->parameter];
  CHECK(count.size() == 2);
  // 1500 expected with a standard deviation of 19.
  CHECK(std::abs(count[TuningParameter::target_weight] - 1500) < 100);
  study.tuning.parameter_weight = {0.0, 0.0, 0.0, 1.0};
  CHECK_THROWS_AS(draw_experiment(study, 0), InputError);
}

TEST_CASE("with_tuning multiplies one weight of the controller and nothing else", "[tuning]") {
  const Study study = short_study({.tuning = 1});
  ExperimentDraw draw;
  draw.tuning = TuningChange{TuningParameter::slack_weight, 4, 0.25};
  const Study changed = with_tuning(study, draw);
  Eigen::VectorXd expected = study.controller.slack_weight;
  expected(4) = 25.0;  // of 100
  CHECK(changed.controller.slack_weight == expected);
  CHECK(changed.controller.move_suppression == study.controller.move_suppression);
  CHECK(changed.controller.target_weight == study.controller.target_weight);
  CHECK(with_tuning(study, ExperimentDraw{}).controller.slack_weight == study.controller.slack_weight);

  const auto refused = [&](const TuningChange& change) {
    CHECK_THROWS_AS(with_tuning(study.controller, change), InputError);
  };
  refused({TuningParameter::setpoint_weight, 0, 2.0});
  refused({TuningParameter::move_suppression, 3, 2.0});
  refused({TuningParameter::move_suppression, -1, 2.0});
  refused({TuningParameter::move_suppression, 0, 0.0});
  refused({TuningParameter::move_suppression, 0, std::nan("")});
}

TEST_CASE("simulate_experiment: a bad tuning is the loop of another controller with its noise", "[tuning]") {
  const Study study = short_study({.tuning = 1});
  const QpSolverFactory factory = qp_solver_factory("active-set");
  ExperimentDraw draw;
  draw.index = 3;
  draw.kind = ExperimentKind::tuning;
  draw.tuning = TuningChange{TuningParameter::move_suppression, 1, 0.1};
  Study by_hand = study;
  by_hand.controller.move_suppression(1) *= 0.1;
  ExperimentDraw healthy;
  healthy.index = 3;
  const Trajectory loop = simulate_experiment(study, draw, factory);
  CHECK(loop.u == simulate_experiment(by_hand, healthy, factory).u);
  CHECK(loop.u != simulate_experiment(study, healthy, factory).u);
}

TEST_CASE("simulate_experiment: a healthy experiment is the basis case with another noise", "[tuning]") {
  Study study = short_study({.healthy = 1});
  const QpSolverFactory factory = qp_solver_factory("active-set");
  CHECK(draw_experiment(study, 5).kind == ExperimentKind::healthy);
  CHECK(simulate_experiment(study, draw_experiment(study, 5), factory).y !=
        simulate_experiment(study, basis_draw(), factory).y);
  study.simulation.noise_standard_deviation.setZero();
  CHECK(simulate_experiment(study, draw_experiment(study, 5), factory).y ==
        simulate_experiment(study, basis_draw(), factory).y);
}

TEST_CASE("study file: healthy experiments and bad tunings are read, and have defaults",
          "[tuning][study_file]") {
  const Study plain = parse_study(small_study(), "s.toml");
  CHECK((plain.experiments.healthy == 0 && plain.experiments.tuning == 0));
  CHECK(plain.tuning.factor == Distribution::log_uniform(0.05, 20));
  CHECK(plain.tuning.sensitivity == TuningSensitivity::current);

  const Study study = parse_study(replaced(small_study(), "mpm_ud = 1", R"(mpm_ud = 1
healthy = 5
tuning = 6
[tuning]
parameter_weights = {move_suppression = 0, target_weight = 2, slack_weight = 3, setpoint_weight = 4}
factor = {uniform = [0.5, 2]}
sensitivity = "design")"),
                                  "s.toml");
  CHECK((study.experiments.healthy == 5 && study.experiments.tuning == 6));
  CHECK(study.experiment_count() == 17);
  CHECK(study.tuning.factor == Distribution::uniform(0.5, 2));
  CHECK(study.tuning.sensitivity == TuningSensitivity::design);
  CHECK(study.tuning.parameter_weight == std::array<double, 4>{0, 2, 3, 4});
  CHECK(study.tuning.weights_for(study.controller) == std::array<double, 4>{0, 2, 3, 0});
}

TEST_CASE("study file: counts and tunings that make no study are refused", "[tuning][study_file]") {
  check_refusals({
      {"mpm_ud = 1", "mpm_ud = 1\nhealthy = -1", "healthy",
       "experiments.healthy: found -1; allowed: a whole number from 0 to 10000000"},
      {"mpm_ud = 1", "mpm_ud = 1\ntuning = 0.5",
       "tuning =", "experiments.tuning: found 0.5; allowed: a whole number from 0 to 10000000"},
      {"mpm_ud = 1", "mpm_ud = 1\n[tuning]\nfactor = {uniform = [-1, 2]}", "factor",
       "tuning.factor: found draws from -1 to 2; allowed: a distribution whose every draw is a number > 0"},
      {"mpm_ud = 1", "mpm_ud = 1\n[tuning]\nsensitivity = 'old'", "sensitivity",
       "tuning.sensitivity: found 'old'; allowed: current, design"},
      {"mpm_ud = 1",
       "mpm_ud = 1\ntuning = 1\n[tuning]\nparameter_weights = {move_suppression = 0, target_weight = 0, "
       "slack_weight = 0, setpoint_weight = 1}",
       "parameter_weights",
       "tuning.parameter_weights: found a weight of 0 for everything that the controller has; allowed: at "
       "least "
       "one > 0"},
      {"mpm_ud = 1", "mpm_ud = 1\n[tuning]\nparameter_weights = {move_suppression = 1}", "parameter_weights",
       "tuning.parameter_weights.target_weight: found nothing; allowed: a number >= 0"},
  });
  std::string named = small_study();
  named.erase(named.find("[experiments]"));
  CHECK(refusal(named + "[[scenario]]\nname = 'a'\n[tuning]\n")
            .find("tuning: found random experiments beside "
                  "named scenarios") != std::string::npos);
}

}  // namespace
