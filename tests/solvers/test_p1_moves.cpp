#include <utility>

#include <catch2/catch.hpp>

#include "plants/models/catalogue.hpp"
#include "scenarios/random/random_stream.hpp"
#include "solvers/mpc.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/p1_controller.hpp"

// The problems of a closed loop of P1 through every back end: full size, as they occur.

namespace mpm {
namespace {

struct Recording {
  std::shared_ptr<const QpStructure> structure;
  std::vector<QpData> problems;
};

/// Hands every problem on to another solver and keeps a copy.
class RecordingSolver final : public QpSolver {
 public:
  RecordingSolver(std::unique_ptr<QpSolver> inner, std::shared_ptr<const QpStructure> structure,
                  Recording& recording)
      : QpSolver(structure), inner_(std::move(inner)), recording_(recording) {
    recording_.structure = std::move(structure);
  }

 private:
  void do_solve(const QpData& data, QpResult& result) override {
    recording_.problems.push_back(data);
    result = inner_->solve(data);
  }
  void do_reset() override { inner_->reset(); }

  std::unique_ptr<QpSolver> inner_;
  Recording& recording_;
};

/// The move problems of `steps` samples of P1 with noise of 1 % and a step of each MD.
Recording p1_loop(SlackForm form, int steps) {
  Recording targets;
  Recording moves;
  const QpSolverFactory factory = [&](std::shared_ptr<const QpStructure> structure) {
    Recording& recording = structure->variable_count() == 3 ? targets : moves;
    auto inner = qp_solver_factory("ipopt")(structure);
    return std::make_unique<RecordingSolver>(std::move(inner), structure, recording);
  };
  MpcOptions options = samples::p1_options();
  options.slack_form = form;
  const TransferMatrix model = benchmark_plant("shell-7x3").G;
  Mpc controller(model, 3, options, factory);
  LinearPlant plant(model, options.sample_time);
  RandomStream random(2015, 0, StreamId::measurement_noise);

  Eigen::Vector2d d(0, 0);
  Eigen::VectorXd input(5);
  input << controller.nominal_target(d), d;
  plant.reset(input);
  controller.reset(input.head(3), d);
  for (int k = 0; k < steps; ++k) {
    d = Eigen::Vector2d(k >= 2 ? 0.4 : 0.0, k >= 4 ? -0.4 : 0.0);
    Eigen::VectorXd y = plant.output();
    for (double& value : y)
      value += 0.01 * random.normal();
    const ControlMove& move = controller.step(y, d);
    REQUIRE(move.status == ControlStatus::ok);
    input << move.u, d;
    plant.advance(input);
  }
  return moves;
}

bool any_soft_limit_active(const QpResult& result) {
  return result.soft_dual.lpNorm<Eigen::Infinity>() > 1e-3;
}

}  // namespace

// The answer of `ipopt` is that of the problem with every limit: with 1 % of noise on CVs at their limits,
// samples on both sides of a limit occur all the time, and the slack forms share nothing but the rows.
TEST_CASE("all back ends make the same moves of P1", "[solvers][p1]") {
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  const Recording loop = p1_loop(form, 6);
  REQUIRE(loop.problems.size() == 6);
  const auto reference = qp_solver_factory("ipopt-full")(loop.structure);
  std::vector<std::unique_ptr<QpSolver>> solvers;
  for (const std::string& name : qp_solver_names())
    if (name != "ipopt-full")
      solvers.push_back(qp_solver_factory(name)(loop.structure));

  for (const std::size_t k : {1, 3, 5}) {  // at rest, and after the step of each MD
    const QpResult& full = reference->solve(loop.problems[k]);
    REQUIRE(full.status == QpStatus::solved);
    CHECK(full.kkt_residual < 1e-7);  // Ipopt's dual_inf_tol, its coarsest tolerance
    CHECK(any_soft_limit_active(full));
    for (const auto& solver : solvers) {
      INFO(to_string(form) << ", step " << k);
      const QpResult& result = solver->solve(loop.problems[k]);
      REQUIRE(result.status == QpStatus::solved);
      CHECK(result.kkt_residual < 1e-7);
      // Some 1600 limits with a complementarity of 1e-10 each leave 1.6e-7 of the objective undecided.
      CHECK(result.objective == Approx(full.objective).margin(2e-7));
      // Such a difference is at least 1/2 * 2 * |dx|^2, as the least eigenvalue of H is 2 (Q_u = 1): |dx| is
      // below 4e-4, a thousandth of the MV range, and in fact far below.
      CHECK((result.x - full.x).lpNorm<Eigen::Infinity>() < 1e-5);
    }
  }
}

}  // namespace mpm
