#include <cmath>

#include <catch2/catch.hpp>

#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"
#include "solvers/mpc.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/plants/allocation_counter.hpp"
#include "tests/solvers/p1_controller.hpp"

// What runs at each sample of a closed loop allocates nothing after set-up.

namespace mpm {

TEST_CASE("a step of the closed loop of P1 allocates nothing, whatever disturbs it", "[mpc][allocation]") {
  const auto back_end = GENERATE(as<std::string>(), "active-set", "auto");
  const auto slack = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  MpcOptions options = samples::p1_options();
  options.slack_form = slack;
  const auto composition = GENERATE(as<std::string>(), "ranges", "ranges and setpoints", "setpoints");
  const bool setpoints = composition != "ranges";
  if (composition == "ranges and setpoints")
    options.setpoint_weight.head(2).setConstant(2.0);
  if (composition == "setpoints") {  // (2.26)
    options.setpoint_weight.setConstant(2.0);
    options.target_weight.setZero();
    options.slack_weight.setZero();
    options.cv_soft = Limits::none(7);
  }
  if (GENERATE(false, true))
    options.md_analysers = {{1, 4}, {3, 2}};
  const PlantModel p1 = benchmark_plant("shell-7x3");
  const auto mv_count = static_cast<Eigen::Index>(p1.mvs.size());
  Mpc controller(p1.G, mv_count, options, qp_solver_factory(back_end));
  LinearPlant plant(p1.G, options.sample_time);

  Eigen::VectorXd d = Eigen::VectorXd::Zero(p1.G.cols() - mv_count);
  Eigen::VectorXd input(p1.G.cols());
  input << controller.nominal_target(d), d;
  controller.reset(input.head(mv_count), d);
  plant.reset(input);
  Eigen::VectorXd y(p1.G.rows());

  Eigen::VectorXd y_set = Eigen::VectorXd::Zero(7);
  int solved = 0;
  const std::size_t before = allocation_count();
  for (int k = 0; k < 150; ++k) {
    d.setConstant(k < 40 ? 0.3 : -0.25);
    y = plant.output();
    for (Eigen::Index i = 0; i < y.size();
         ++i)  // noise, and a slow wave that drives some CVs over their limits
      y(i) += 0.01 * std::sin(3.7 * k + 1.3 * static_cast<double>(i)) + 0.15 * std::sin(0.05 * k);
    y_set.head(2).setConstant(k < 70 ? 0.1 : 0.2);
    if (setpoints)
      controller.set_setpoints(y_set);
    const ControlMove& move = controller.step(y, d);
    solved += move.status == ControlStatus::ok ? 1 : 0;
    input << move.u, d;
    plant.advance(input);
  }
  const std::size_t after = allocation_count();
  CHECK(after - before == 0);
  CHECK(solved > 100);
}

}  // namespace mpm
