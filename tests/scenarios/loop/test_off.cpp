#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"
#include "tests/solvers/active_set_factory.hpp"

// MVs and CVs that are off for a while in the loops of a study. What the controller does then is in
// tests/solvers/test_mpc_off.cpp.

namespace mpm {
namespace {

/// The small study with these tables [[simulation.off]]. Its MV cold has a limit, which is what its target
/// has where heat is off.
std::string off_text(const std::string& tables) {
  const std::string bounded =
      testing::replaced(testing::small_study(), "hard = [-inf, inf]", "hard = [-1, inf]");
  return testing::replaced(bounded, "noise_standard_deviation = 0.01",
                           "noise_standard_deviation = 0.01\noff = [" + tables + "]");
}

/// The level may be anywhere: an operator holds an MV where it breaks the hard limits of a CV.
Study off_study(const std::string& tables) {
  Study study = parse_study(off_text(tables), "s.toml");
  study.controller.cv_hard.lower(0) = -kInfinity;
  study.controller.cv_hard.upper(0) = kInfinity;
  return study;
}

Trajectory loop_with(const Study& study) {
  const Trajectory loop = simulate_experiment(study, basis_draw(), testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  return loop;
}

TEST_CASE("an MV that is off acts where its operator puts it, and without a level stays where it was",
          "[off]") {
  const Trajectory all = loop_with(off_study("{mv = 'hot', sample = 59, samples = 1}"));
  const Study study = off_study(
      "{mv = 'hot', sample = 20, samples = 5}, {mv = 'hot', sample = 30, samples = 10, level = 0.125}, "
      "{mv = 'hot', sample = 25, samples = 5, level = 6}");  // 6 is beyond the hard limit of 5
  const Trajectory loop = loop_with(study);
  CHECK(loop.u.leftCols(20) == all.u.leftCols(20));
  CHECK(loop.y.leftCols(21) == all.y.leftCols(21));
  CHECK((loop.u.row(0).segment(20, 5).array() == loop.u(0, 19)).all());
  CHECK((loop.u.row(0).segment(25, 5).array() == 6.0).all());
  CHECK((loop.u.row(0).segment(30, 10).array() == 0.125).all());
  CHECK((loop.u_target.row(0).segment(30, 10).array() == 0.125).all());
  CHECK(loop.u(0, 40) != 0.125);
  // It is what the plant gets: gain 2, dead time 3, time constant 10, of which 7 samples are not enough.
  CHECK(loop.y(0, 33) - loop.y(0, 28) > 2.0);
}

TEST_CASE("a dither waits while its MV is off", "[off]") {
  Study study = off_study("{mv = 'hot', sample = 20, samples = 10}");
  study.simulation.dither = {{0, 0.05, 1}};
  const Trajectory loop = loop_with(study);
  CHECK((loop.u.row(0).segment(20, 10).array() == loop.u(0, 19)).all());
  CHECK((loop.u.row(0).segment(30, 10).array() != loop.u(0, 19)).any());
}

TEST_CASE("soft limits of a CV that is off are none, and are back where they have moved to", "[off]") {
  const Study study = parse_study(
      testing::replaced(off_text("{cv = 'heat', sample = 10, samples = 20}"),
                        "off = ", "limit_step = [{cv = 'heat', sample = 15, soft = [-inf, 0.2]}]\noff = "),
      "s.toml");
  CHECK(soft_limits(study, 9).upper(1) == 0.5);
  CHECK(soft_limits(study, 15).upper(1) == kInfinity);
  CHECK(soft_limits(study, 30).upper(1) == 0.2);
  CHECK_FALSE(is_off(study, VariableSort::mv, 1, 15));
  std::vector<double> told;  // upper limit of the first row of heat, less its free response
  const std::unique_ptr<Plant> plant = experiment_plant(study, basis_draw());
  const Trajectory loop = run_closed_loop(study, *plant, experiment_signals(study, basis_draw()),
                                          testing::kFactory, [&told](const Controller& controller) {
                                            told.push_back(controller.move_problem()->data.soft_upper(20));
                                          });
  REQUIRE(loop.status == ControlStatus::ok);
  for (std::size_t k = 0; k < told.size(); ++k)
    CHECK(std::isinf(told[k]) == (k >= 10 && k < 30));
  Study calm = study;
  calm.simulation.off.clear();
  CHECK(loop_with(calm).u.leftCols(10) == loop.u.leftCols(10));
}

TEST_CASE("every loop has the same spells, also where each has an excitation of its own", "[off]") {
  Study study = off_study(
      "{mv = 'hot', sample = 20, samples = 5, level = 0.1}, {cv = 'heat', sample = 3, samples = 9}");
  study.simulation.excitation = SignalSequence::each;
  CHECK(with_excitation(study, 3).simulation.off == study.simulation.off);
  CHECK(with_excitation(study, 3).simulation.steps != study.simulation.steps);
  const ExperimentDraw draw = draw_experiment(study, 1);
  CHECK((simulate_experiment(study, draw, testing::kFactory).u.row(0).segment(20, 5).array() == 0.1).all());
}

TEST_CASE("an MV off in a shipped study: both solvers agree, CVs come back into their ranges", "[off]") {
  Study study = find_study("chapter6");
  study.simulation.samples = 300;
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.off = {{VariableSort::mv, 1, 40, 60, 0.1}, {VariableSort::cv, 0, 60, 80, {}}};
  const Trajectory fast = loop_with(study);
  const Trajectory ipopt = simulate_experiment(study, basis_draw(), qp_solver_factory("ipopt"));
  REQUIRE(ipopt.status == ControlStatus::ok);
  CHECK((fast.u - ipopt.u).cwiseAbs().maxCoeff() < 1e-4);  // an interior point near a limit
  study.simulation.off.clear();
  const Trajectory all = loop_with(study);
  CHECK((fast.u - all.u).cwiseAbs().maxCoeff() > 0.01);
}

TEST_CASE("wrong tables of variables that are off are refused", "[off]") {
  const auto off = [](const std::string& table) {
    return testing::Refusal{"noise_standard_deviation = 0.01",
                            "noise_standard_deviation = 0.01\noff = [" + table + "]", "off = ", ""};
  };
  const auto refused = [&](const std::string& table, const std::string& message) {
    testing::Refusal refusal = off(table);
    refusal.message = message;
    return refusal;
  };
  testing::check_refusals({
      refused("{sample = 3, samples = 4}",
              "simulation.off[0]: found neither mv nor cv; allowed: exactly one of the two"),
      refused("{mv = 'hot', cv = 'heat', sample = 3, samples = 4}",
              "simulation.off[0]: found both mv and cv; allowed: exactly one of the two"),
      refused("{mv = 'drain', sample = 3, samples = 4}",
              "simulation.off[0].mv: found 'drain'; allowed: hot, cold"),
      refused("{cv = 'hot', sample = 3, samples = 4}",
              "simulation.off[0].cv: found 'hot'; allowed: level, heat"),
      refused("{mv = 'hot', sample = 60, samples = 4}",
              "simulation.off[0].sample: found 60; allowed: a whole number from 0 to 59"),
      refused("{mv = 'hot', sample = 3, samples = 0}",
              "simulation.off[0].samples: found 0; allowed: a whole number from 1 to 60"),
      refused("{mv = 'hot', sample = 3, samples = 4, level = inf}",
              "simulation.off[0].level: found inf; allowed: a finite number"),
      refused("{cv = 'heat', sample = 3, samples = 4, level = 1}",
              "simulation.off[0].level: found where a CV is held; allowed: none, or the MV that is held"),
      refused(
          "{mv = 'hot', sample = 6, samples = 4}, {mv = 'hot', sample = 3, samples = 4}",
          "simulation.off: found a table of hot that begins at sample 6, and one before it that ends at 7; "
          "allowed: tables of one variable one after the other"),
  });
  CHECK(testing::refusal(
            off_text("{mv = 'hot', sample = 3, samples = 3}, {mv = 'cold', sample = 4, samples = 9}, "
                     "{mv = 'hot', sample = 6, samples = 60}")) == "accepted");
  std::string undetermined =
      testing::replaced(off_text("{cv = 'level', sample = 3, samples = 4}"), "[controller.cv.level]\n",
                        "[controller.cv.level]\nsetpoint_weight = 4\nsetpoint = 0.1\n");
  CHECK(testing::refusal(undetermined) == "accepted");
  undetermined = testing::replaced(undetermined, "move_suppression = 7", "move_suppression = 0");
  CHECK_THAT(testing::refusal(undetermined),
             Catch::Contains("simulation.off[0].cv: found a CV with a setpoint, beside the MV cold without "
                             "move_suppression and target_weight"));
}

}  // namespace
}  // namespace mpm
