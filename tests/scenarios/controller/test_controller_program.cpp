#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "base/system/surroundings.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/study/study_controller.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"

// The controller tests/scenarios/odd_controller.py, when it does what it should and when it does not.

namespace mpm {
namespace {

using namespace mpm::testing;
using Catch::Matchers::Contains;

Study odd_study(const std::string& how, double time_limit = 60.0) {
  return parse_study(
      replaced(small_study(), "[controller.mv.hot]",
               fmt::format("[controller.program]\ncommand = ['{}', '-B', '{}', '{}']\ntime_limit = {}\n\n"
                           "[controller.mv.hot]",
                           MPMBENCH_PYTHON3, MPMBENCH_ODD_CONTROLLER, how, time_limit)),
      "s.toml");
}

LoopSignals signals_of(const Study& study) {
  return {measured_disturbances(study), measurement_noise(study, 1),
          Eigen::MatrixXd::Zero(study.cv_count(), study.simulation.samples)};
}

Trajectory loop_of(const Study& study) {
  return run_closed_loop(study, study.plant.G, signals_of(study), qp_solver_factory("active-set"));
}

/// The law of odd_controller.py, in this process.
Trajectory expected_loop(const Study& study) {
  const LoopSignals signals = signals_of(study);
  Trajectory loop;
  loop.y.setZero(2, study.simulation.samples);
  loop.u.setZero(2, study.simulation.samples);
  LinearPlant plant(study.plant.G, study.controller.sample_time);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(3);
  input.head(2) = loop_of(study).u_target.col(0);  // where it starts: the targets of the reset
  plant.reset(input);
  const Limits& hard = study.controller.mv_hard;
  for (Eigen::Index k = 0; k < loop.y.cols(); ++k) {
    loop.y.col(k) = plant.output() + signals.noise.col(k);
    input.head(2) =
        (0.5 * input.head(2) - 0.3 * loop.y.col(k)).cwiseMax(hard.lower).cwiseMin(hard.upper).eval();
    input.tail(1) = signals.d.col(k);
    loop.u.col(k) = input.head(2);
    plant.advance(input);
  }
  return loop;
}

TEST_CASE("controller program: the loop is that of its law", "[controller-program]") {
  const Study study = odd_study("fine");
  const Trajectory loop = loop_of(study), expected = expected_loop(study);
  REQUIRE(loop.status == ControlStatus::ok);
  // The same sums in Python and here, of numbers that JSON hands over to the last bit.
  CHECK((loop.u - expected.u).lpNorm<Eigen::Infinity>() < 1e-12);
  CHECK((loop.y - expected.y).lpNorm<Eigen::Infinity>() < 1e-12);
  CHECK(std::isnan(loop.solver.largest_kkt_residual));
  CHECK(loop.solver.iterations == 0);
  CHECK((loop.u_target.colwise() - loop.u_target.col(0)).isZero(0.0));
}

TEST_CASE("controller program: a loop is the same again, whatever was before", "[controller-program]") {
  const Study study = odd_study("fine");
  const Trajectory first = loop_of(study);
  Study other = study;  // copies share the program
  other.controller.mv_hard.upper(0) = 0.1;
  CHECK(loop_of(other).u != first.u);
  CHECK(loop_of(study).u == first.u);
  CHECK(loop_of(odd_study("fine")).u == first.u);
}

TEST_CASE("controller program: what it does wrong fails its loop, and the next one has another program",
          "[controller-program]") {
  const std::vector<std::pair<std::string, std::string>> ways{
      {"dies", "ended with code 1; at the end of its stderr: out of ideas"},
      {"crashes", "ended by signal 11"},
      {"garbage", "found the line 'never mind'; allowed: a JSON object with the number of the message"},
      {"list", "found the line '[1, 2]'"},
      {"no-number", "a JSON object with the number of the message"},
      {"of-later", "a JSON object with the number of the message"},
      {"short", "\"u\" with 2 finite numbers, one for each MV"},
      {"text", "\"u\" with 2 finite numbers, one for each MV"},
      {"none", "\"u\" with 2 finite numbers, one for each MV"},
      {"nan", "a JSON object with the number of the message"},
      {"key", "found the key 'v' in "},
      {"error", "the controller program says: \"dry\""}};
  for (const auto& [how, message] : ways) {
    INFO(how);
    const Study study = odd_study(how);
    for (int again = 0; again < 2; ++again) {
      const Trajectory loop = loop_of(study);
      CHECK(loop.status == ControlStatus::failed);
      CHECK(loop.failure == LoopFailure::controller);
      CHECK(loop.samples_done == 2);
      CHECK_THAT(loop.message, Contains(message));
    }
  }
}

TEST_CASE("controller program: one that somebody kills has not failed", "[controller-program]") {
  CHECK_THROWS_AS(loop_of(odd_study("killed")), SurroundingsFailure);
}

TEST_CASE("controller program: one that hangs is given up", "[controller-program]") {
  const Trajectory loop = loop_of(odd_study("hangs", 2.0));
  CHECK(loop.failure == LoopFailure::controller);
  CHECK_THAT(loop.message, Contains("did not answer in time"));
}

TEST_CASE("controller program: neither a second answer nor a flood on stderr changes its loop",
          "[controller-program]") {
  const Trajectory expected = loop_of(odd_study("fine"));
  CHECK(loop_of(odd_study("twice")).u == expected.u);
  CHECK(loop_of(odd_study("floods")).u == expected.u);
}

TEST_CASE("controller program: infeasible, beyond the limits, and with targets", "[controller-program]") {
  const Trajectory infeasible = loop_of(odd_study("infeasible"));
  CHECK(infeasible.status == ControlStatus::infeasible);
  CHECK(infeasible.failure == LoopFailure::none);
  const Study study = odd_study("beyond");
  CHECK(loop_of(study).u(0, 2) == study.controller.mv_hard.upper(0));
  const Trajectory targets = loop_of(odd_study("targets"));
  CHECK(targets.u_target(0, 1) != 1.0);
  CHECK(targets.u_target.col(2) == Eigen::Vector2d(1.0, 2.0));
}

TEST_CASE("controller program: it is told what is off, and does not move it", "[controller-program]") {
  Study study = odd_study("off");
  study.simulation.off = {{VariableSort::cv, 0, 5, 5, {}}, {VariableSort::mv, 1, 5, 5, 0.25}};
  const Trajectory loop = loop_of(study);
  INFO(loop.message);
  REQUIRE(loop.status == ControlStatus::ok);
  CHECK((loop.u.row(1).segment(5, 5).array() == 0.25).all());
  CHECK((loop.u_target.row(1).segment(5, 5).array() == 0.25).all());
  CHECK(loop.u(1, 10) != 0.25);
  CHECK(loop.u(1, 10) == Approx(0.5 * 0.25 - 0.3 * loop.y(1, 10)).epsilon(1e-12));  // it goes on from there
}

TEST_CASE("controller program: what it says of itself", "[controller-program]") {
  CHECK(runs_on_model(odd_study("fine")));
  CHECK(!runs_on_model(odd_study("plant-only")));
  CHECK_THROWS_WITH(runs_on_model(odd_study("odd-description")),
                    Contains("\"maybe\"") && Contains("\"on_model\": true or false"));
  const Study missing = parse_study(
      replaced(small_study(), "[controller.mv.hot]",
               "[controller.program]\ncommand = [\"mpmbench-no-such-program\"]\n\n[controller.mv.hot]"),
      "s.toml");
  CHECK_THROWS_WITH(runs_on_model(missing), Contains("mpmbench-no-such-program"));
  CHECK(loop_of(missing).failure == LoopFailure::controller);
}

TEST_CASE("controller program: what the study says of it", "[controller-program]") {
  const auto message = [](const std::string& keys) {
    return refusal(replaced(small_study(), "[controller.mv.hot]",
                            "[controller.program]\n" + keys + "\n[controller.mv.hot]"));
  };
  CHECK(message("command = ['mpc']") == "accepted");
  CHECK_THAT(message(""), Contains("controller.program.command: found nothing; allowed: a list of texts"));
  CHECK_THAT(message("command = 'mpc'"), Contains("controller.program.command: found 'mpc'"));
  CHECK_THAT(message("command = ['']"), Contains("the program and its arguments"));
  CHECK_THAT(message("command = ['mpc']\ntime_limit = 0"),
             Contains("controller.program.time_limit: found 0"));
  CHECK_THAT(message("command = ['mpc']\ntime_limit = 1e6"), Contains("at most 86400"));
  CHECK_THAT(message("command = ['mpc']\nsettle = 1"), Contains("unknown key 'settle'"));
}

TEST_CASE("controller program: a forked process has programs of its own", "[controller-program]") {
  const Study study = odd_study("fine");
  const Trajectory here = loop_of(study);  // its program waits for the next loop
  const pid_t child = ::fork();
  if (child == 0)
    ::_exit(loop_of(study).u == here.u ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(loop_of(study).u == here.u);
}

}  // namespace
}  // namespace mpm
