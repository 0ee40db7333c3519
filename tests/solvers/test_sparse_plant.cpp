#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"
#include "solvers/lanes/row_band.hpp"
#include "solvers/mpc.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/plants/allocation_counter.hpp"
#include "tests/solvers/p1_controller.hpp"

namespace mpm {
namespace {

// Both loops stop at a residual of 1e-10 each step, and feed the differences back.
constexpr double kSameMoves = 1e-7;

Eigen::VectorXd doubled(const Eigen::VectorXd& values) {
  Eigen::VectorXd result(2 * values.size());
  result << values, values;
  return result;
}

Limits doubled(const Limits& limits) {
  return {doubled(limits.lower), doubled(limits.upper)};
}

MpcOptions doubled(MpcOptions options) {
  for (Eigen::VectorXd* values : {&options.move_suppression, &options.target_weight, &options.setpoint_weight,
                                  &options.slack_weight, &options.mv_cost})
    *values = doubled(Eigen::VectorXd(*values));
  for (Limits* limits : {&options.mv_hard, &options.cv_hard, &options.cv_soft})
    *limits = doubled(Limits(*limits));
  return options;
}

/// Two plants that have nothing to do with each other; MVs of both, then MDs of both.
TransferMatrix side_by_side(const TransferMatrix& G, Eigen::Index mv_count) {
  const Eigen::Index mds = G.cols() - mv_count;
  TransferMatrix result(2 * G.rows(), 2 * G.cols());
  for (Eigen::Index half = 0; half < 2; ++half)
    for (Eigen::Index i = 0; i < G.rows(); ++i)
      for (Eigen::Index j = 0; j < G.cols(); ++j) {
        const Eigen::Index column =
            j < mv_count ? half * mv_count + j : 2 * mv_count + half * mds + j - mv_count;
        result(half * G.rows() + i, column) = G(i, j);
      }
  return result;
}

}  // namespace

TEST_CASE("a controller of two plants moves each as its own controller does, and allocates nothing",
          "[mpc][allocation]") {
  const PlantModel p1 = benchmark_plant("shell-7x3");
  MpcOptions options = samples::p1_options();
  options.slack_form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const TransferMatrix both = side_by_side(p1.G, 3);
  Mpc single(p1.G, 3, options, factory);
  Mpc controller(both, 6, doubled(options), factory);
  LinearPlant plant(both, options.sample_time);

  Eigen::VectorXd d = Eigen::VectorXd::Zero(4);
  Eigen::VectorXd input(10);
  input << controller.nominal_target(d), d;
  single.reset(input.head(3), d.head(2));
  controller.reset(input.head(6), d);
  plant.reset(input);
  controller.step(plant.output(), d);
  REQUIRE(row_bands(controller.move_problem()->structure.rows).size() == 2);
  controller.reset(input.head(6), d);

  Eigen::VectorXd y(14);
  double difference = 0.0;
  int solved = 0;
  const std::size_t before = allocation_count();
  for (int k = 0; k < 100; ++k) {
    d << (k < 40 ? 0.3 : -0.25), 0.1, (k < 60 ? -0.2 : 0.2), 0.0;
    y = plant.output();
    for (Eigen::Index i = 0; i < y.size(); ++i)
      y(i) += 0.01 * std::sin(3.7 * k + 1.3 * static_cast<double>(i)) + 0.15 * std::sin(0.05 * k);
    const ControlMove& alone = single.step(y.head(7), d.head(2));
    const ControlMove& move = controller.step(y, d);
    solved += move.status == ControlStatus::ok && alone.status == ControlStatus::ok ? 1 : 0;
    difference = std::max(difference, (move.u.head(3) - alone.u).cwiseAbs().maxCoeff());
    input << move.u, d;
    plant.advance(input);
  }
  CHECK(allocation_count() - before == 0);
  CHECK(solved == 100);
  CHECK(difference <= kSameMoves);
}

}  // namespace mpm
