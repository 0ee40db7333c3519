#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace {

using namespace mpm;

TEST_CASE("closed loop: the basis case holds y1 and y2 at their lower limit and y7 at its upper one") {
  Study study = find_study("chapter6");
  study.simulation.samples = 120;
  study.simulation.steps.clear();
  study.simulation.steps.push_back({0, 5, 0.3});
  study.simulation.noise_standard_deviation.setZero();
  for (const char* solver : {"ipopt", "active-set"}) {
    if (std::string(solver) == "ipopt")
      study.simulation.samples = 90;
    const Trajectory loop = simulate_experiment(study, basis_draw(), qp_solver_factory(solver));
    REQUIRE(loop.status == ControlStatus::ok);
    // Settled long after the step; what is left is the tail of the slowest loop.
    const Eigen::VectorXd last = loop.y.rightCols<1>();
    CHECK(std::abs(last(0)) < 2e-3);
    CHECK(std::abs(last(1)) < 2e-3);
    CHECK(std::abs(last(6)) < 2e-3);
    CHECK(loop.u.cwiseAbs().maxCoeff() < 0.5);  // all MVs free
    CHECK(loop.solver.largest_kkt_residual < 1e-8);
  }
}

TEST_CASE("closed loop: back ends give the same loop") {
  Study study = find_study("chapter6");
  study.simulation.samples = 30;
  study.simulation.steps.resize(1);
  const ExperimentDraw draw = draw_experiment(study, 1);
  const Trajectory reference = simulate_experiment(study, draw, qp_solver_factory("ipopt"));
  const Trajectory fast = simulate_experiment(study, draw, qp_solver_factory("active-set"));
  REQUIRE(reference.status == fast.status);
  // Ipopt stops at a complementarity of 1e-10, which leaves the moves uncertain by about its square root over
  // the curvature of the cost.
  CHECK((reference.u - fast.u).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("closed loop: a measured output far outside its hard limits makes the loop infeasible there") {
  Study study = find_study("chapter6");
  study.simulation.samples = 20;
  LoopSignals signals{measured_disturbances(study), Eigen::MatrixXd::Zero(7, 20),
                      Eigen::MatrixXd::Zero(7, 20)};
  signals.y_d.row(0).tail(10).setConstant(1.5);  // beyond 1, and y1 has 27 min of dead time
  for (const char* solver : {"ipopt", "active-set"}) {
    const Trajectory loop = run_closed_loop(study, study.plant.G, signals, qp_solver_factory(solver));
    CHECK(loop.status == ControlStatus::infeasible);
    CHECK(loop.samples_done == 10);
  }
  signals.noise.resize(7, 19);
  CHECK_THROWS_AS(run_closed_loop(study, study.plant.G, signals, qp_solver_factory("active-set")),
                  InputError);
}

TEST_CASE("signals: disturbance steps, noise and G_d v are what the study says") {
  Study study = find_study("chapter6");
  const Eigen::MatrixXd d = measured_disturbances(study);
  CHECK(d.col(0).isZero());
  for (const SignalStep& step : study.simulation.steps)
    CHECK(d(step.variable, step.sample) == step.level);

  study.simulation.samples = 4000;
  const Eigen::MatrixXd noise = measurement_noise(study, 5);
  for (Eigen::Index cv = 0; cv < noise.rows(); ++cv) {
    const double deviation = study.simulation.noise_standard_deviation(cv);
    // Standard error of a standard deviation from 4000 values: 1.1 %; five of them.
    CHECK(std::sqrt(noise.row(cv).squaredNorm() / 4000) == Approx(deviation).epsilon(0.056));
  }

  ExperimentDraw draw;
  draw.index = 3;
  draw.kind = ExperimentKind::ud;
  draw.disturbances = {{2, 1.5, 40.0}};
  const Eigen::MatrixXd y_d = unmeasured_disturbances(study, draw);
  CHECK(y_d.row(1).isZero());
  // y_d(k+1) = a y_d(k) + g (1 - a) v(k): its innovations are white with deviation g (1 - a).
  const double a = std::exp(-4.0 / 40.0);
  const Eigen::RowVectorXd v = (y_d.row(2).tail(3999) - a * y_d.row(2).head(3999)) / (1.5 * (1 - a));
  CHECK(std::sqrt(v.squaredNorm() / 3999) ==
        Approx(1.0).epsilon(0.06));  // standard error 1.1 %; five of them
  CHECK(std::abs(v.head(3998).dot(v.tail(3998)) / v.squaredNorm()) < 5.0 / std::sqrt(3998.0));
}

}  // namespace
