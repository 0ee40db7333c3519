#include <cmath>

#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "plants/models/catalogue.hpp"
#include "solvers/active_set_solver.hpp"
#include "solvers/ipopt_solver.hpp"
#include "solvers/mpc_qp.hpp"
#include "tests/plants/allocation_counter.hpp"
#include "tests/solvers/p1_controller.hpp"
#include "tests/solvers/qp_builder.hpp"

// The active-set back end on sequences of the QP of P1, as a controller meets them.

namespace mpm {
namespace {

using samples::QpBuilder;
using samples::vec;

constexpr Eigen::Index kMvs = 3;

/// Free responses of P1 that drift out of the soft limits, at times near the hard ones, and come back, with a
/// jump a sample as measurement noise makes it.
class P1Sequence {
 public:
  explicit P1Sequence(SlackForm form) : options_(options(form)), qp_(plant_.G, kMvs, options_) {
    free_.setZero(plant_.G.rows(), options_.prediction_horizon);
    previous_.setZero(kMvs);
    target_.setZero(kMvs);
  }

  std::shared_ptr<const QpStructure> structure() const { return qp_.structure(); }

  const QpData& at(int k) {
    for (Eigen::Index cv = 0; cv < free_.rows(); ++cv)
      for (Eigen::Index l = 0; l < free_.cols(); ++l)
        free_(cv, l) =
            0.7 * std::sin(0.11 * k + 1.7 * static_cast<double>(cv) + 0.02 * static_cast<double>(l)) +
            0.02 * std::sin(13.0 * k + 5.0 * static_cast<double>(cv));
    previous_ = Eigen::Vector3d(std::sin(0.3 * k), std::cos(0.2 * k), std::sin(0.17 * k)) * 0.45;
    target_.setConstant(0.5 * std::cos(0.05 * k));
    return qp_.update({free_, previous_, target_, no_setpoint_, no_setpoint_});
  }

 private:
  static MpcOptions options(SlackForm form) {
    MpcOptions result = samples::p1_options();
    result.slack_form = form;
    return result;
  }

  PlantModel plant_ = benchmark_plant("shell-7x3");
  MpcOptions options_;
  MpcQp qp_;
  Eigen::MatrixXd free_;
  Eigen::VectorXd no_setpoint_ = Eigen::VectorXd::Zero(7);
  Eigen::VectorXd previous_, target_;
};

}  // namespace

TEST_CASE("a warm start changes the work, not the answer", "[active-set]") {
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  P1Sequence sequence(form);
  ActiveSetSolver warm(sequence.structure(), ActiveSetOptions{});
  ActiveSetSolver cold(sequence.structure(), ActiveSetOptions{});
  int warm_iterations = 0;
  int cold_iterations = 0;
  for (int k = 0; k < 60; ++k) {
    const QpData& data = sequence.at(k);
    cold.reset();
    const QpResult& expected = cold.solve(data);
    const QpResult& result = warm.solve(data);
    INFO(to_string(form) << ", sample " << k);
    REQUIRE(result.status == expected.status);
    if (result.status != QpStatus::solved)
      continue;
    CHECK(result.kkt_residual <= 1e-9);
    // Both satisfy the conditions to 1e-9 and H is at least 2 in every direction.
    CHECK((result.x - expected.x).lpNorm<Eigen::Infinity>() <= 1e-7);
    warm_iterations += result.iterations;
    cold_iterations += expected.iterations;
  }
  CHECK(warm_iterations < cold_iterations);
}

TEST_CASE("a limit that pushes may be gone in the next program", "[active-set]") {
  QpBuilder builder("vanishing", Eigen::Matrix2d::Identity(), vec(-3, -2));
  builder.slack(5.0, 0.0).soft(vec(1, 0.5), 0, -1, 1);
  const samples::NamedQp qp = builder.build();
  ActiveSetSolver solver(qp.structure, ActiveSetOptions{});
  REQUIRE(solver.solve(qp.data).status == QpStatus::solved);
  REQUIRE(solver.result().soft_dual(0) > 0.0);

  QpData without = qp.data;
  without.soft_upper(0) = kInfinity;
  for (const QpData& data : {without, qp.data, without}) {
    const QpResult& result = solver.solve(data);
    ActiveSetSolver fresh(qp.structure, ActiveSetOptions{});
    REQUIRE(result.status == QpStatus::solved);
    CHECK((result.x - fresh.solve(data).x).norm() <= 1e-12);  // two variables: a few roundings
  }
}

TEST_CASE("the active-set answers on P1 are those of Ipopt", "[active-set]") {
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  P1Sequence sequence(form);
  ActiveSetSolver solver(sequence.structure(), ActiveSetOptions{});
  IpoptSolver reference(sequence.structure(), IpoptOptions{});
  for (int k = 0; k < 60; k += 10) {
    const QpData& data = sequence.at(k);
    const QpResult& expected = reference.solve(data);
    const QpResult& result = solver.solve(data);
    INFO(to_string(form) << ", sample " << k);
    REQUIRE(result.status == expected.status);
    if (result.status != QpStatus::solved)
      continue;
    CHECK(result.objective == Approx(expected.objective).epsilon(1e-6).margin(1e-6));
    // Ipopt leaves multiplier * distance = 1e-10 at each limit: distances of 1e-5 where both vanish.
    CHECK((result.x - expected.x).lpNorm<Eigen::Infinity>() <= 1e-4);
  }
}

TEST_CASE("solve allocates nothing", "[active-set][allocation]") {
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  P1Sequence sequence(form);
  ActiveSetSolver solver(sequence.structure(), ActiveSetOptions{});
  int solved = 0;
  const std::size_t before = allocation_count();
  for (int k = 0; k < 60; ++k)
    solved += solver.solve(sequence.at(k)).status == QpStatus::solved;
  const std::size_t after = allocation_count();
  CHECK(after - before == 0);
  CHECK(solved > 30);
}

}  // namespace mpm
