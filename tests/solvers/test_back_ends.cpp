#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/qp_builder.hpp"
#include "tests/solvers/qp_collection.hpp"

// What every back end has to do: the collection of problems, sequences of problems, and its manners.

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

// The back ends promise stationarity to 1e-7 or better (Ipopt: dual_inf_tol 1e-7) and feasibility and
// complementarity to 1e-8 or better; Ipopt also accepts a point with a residual of 1e-7.
constexpr double kResidual = 1e-7;

// An interior-point method stops where multiplier * distance = 1e-10 at every limit. At a limit that touches
// without pushing both factors are then 1e-5, and x is off by as much, times the conditioning of H (below 10
// in the collection).
constexpr double kDistance = 1e-4;

// The objective is off by the sum of the complementarities, and by multiplier times feasibility error: at
// most some hundred limits of 1e-10 each.
constexpr double kObjective = 1e-7;

void check_answer(const NamedQp& qp, const QpResult& result) {
  CHECK(to_string(result.status) == to_string(qp.expected));
  if (qp.expected != QpStatus::solved) {
    CHECK(std::isinf(result.kkt_residual));
    return;
  }
  CHECK(result.kkt_residual < kResidual);
  CHECK(result.kkt_residual == kkt_residual(*qp.structure, qp.data, result));
  CHECK(result.objective == objective(*qp.structure, qp.data, result));
  if (qp.x)
    CHECK((result.x - *qp.x).lpNorm<Eigen::Infinity>() < kDistance);
}

void check_agreement(const NamedQp& qp, const QpResult& one, const QpResult& other) {
  if (qp.expected != QpStatus::solved)
    return;
  CHECK(one.objective == Approx(other.objective).epsilon(kObjective).margin(kObjective));
  if (qp.unique)
    CHECK((one.x - other.x).lpNorm<Eigen::Infinity>() < kDistance);
}

/// A walk through problems of one structure: every step changes gradient and limits a little.
void move_on(RandomStream& random, QpData& data) {
  for (double& number : data.gradient)
    number += random.uniform(-0.2, 0.2);
  for (Eigen::Index i = 0; i < data.soft_lower.size(); ++i) {
    const double shift = random.uniform(-0.2, 0.2);
    data.soft_lower(i) += shift;
    data.soft_upper(i) += shift;
  }
}

NamedQp find(const std::string& name) {
  for (const NamedQp& qp : samples::qp_collection())
    if (qp.name == name)
      return qp;
  throw InputError("test problem", name, "one of the collection");
}

/// Answers with zeros, and calls that solved.
class HopefulSolver final : public QpSolver {
 public:
  using QpSolver::QpSolver;

 private:
  void do_solve(const QpData&, QpResult& result) override { result.status = QpStatus::solved; }
  void do_reset() override {}
};

}  // namespace

TEST_CASE("an answer that breaks a condition by more than the stated residual is not solved", "[back_ends]") {
  const auto structure = std::make_shared<QpStructure>();
  structure->hessian = Eigen::MatrixXd::Identity(1, 1);
  structure->rows.setZero(0, 1);
  structure->slack_of_row.resize(0);
  structure->slack_quadratic.resize(0);
  structure->slack_linear.resize(0);
  QpData data = QpData::unconstrained(*structure);
  HopefulSolver solver(structure);
  data.gradient(0) = 0.5 * kSolvedKktResidual;
  CHECK(solver.solve(data).status == QpStatus::solved);
  CHECK(solver.solve(data).kkt_residual == data.gradient(0));
  data.gradient(0) = 2.0 * kSolvedKktResidual;
  CHECK(solver.solve(data).status == QpStatus::numerical_error);
  CHECK(std::isinf(solver.result().kkt_residual));
}

TEST_CASE("every back end solves the collection, and they agree", "[solvers]") {
  for (const NamedQp& qp : samples::qp_collection()) {
    const QpResult reference = qp_solver_factory("ipopt-full")(qp.structure)->solve(qp.data);
    for (const std::string& back_end : qp_solver_names()) {
      INFO(back_end << ": " << qp.name);
      const QpResult result = qp_solver_factory(back_end)(qp.structure)->solve(qp.data);
      check_answer(qp, result);
      check_agreement(qp, result, reference);
    }
  }
}

TEST_CASE("a warm start does not change the answer", "[solvers]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  NamedQp qp = GENERATE(find("shared slacks, quadratic #0"), find("a slack a row, both #1"));
  qp.x.reset();
  RandomStream random(1, 0, StreamId::excitation);
  const auto warm = qp_solver_factory(back_end)(qp.structure);
  for (int step = 0; step < 12; ++step) {
    INFO(back_end << ": " << qp.name << ", step " << step);
    const QpResult result = warm->solve(qp.data);
    check_answer(qp, result);
    check_agreement(qp, result, qp_solver_factory(back_end)(qp.structure)->solve(qp.data));
    move_on(random, qp.data);
  }
}

TEST_CASE("after a reset the answer depends on its problem alone", "[solvers]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  const NamedQp qp = find("a slack a row, both #1");
  QpData other = qp.data;
  other.gradient *= -1.0;
  const auto solver = qp_solver_factory(back_end)(qp.structure);
  const QpResult first = solver->solve(qp.data);
  solver->solve(other);
  solver->reset();
  const QpResult& again = solver->solve(qp.data);
  CHECK(again.x == first.x);  // bit for bit
  CHECK(again.slack == first.slack);
  CHECK(again.soft_dual == first.soft_dual);
  CHECK(again.iterations == first.iterations);
}

TEST_CASE("a solver recovers from an infeasible problem", "[solvers]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  const NamedQp qp = find("hard rows #0");
  QpData impossible = qp.data;
  impossible.hard_lower(0) = 1e3;  // the box allows a value of about 10
  impossible.hard_upper(0) = 1e4;
  const auto solver = qp_solver_factory(back_end)(qp.structure);
  for (int round = 0; round < 2; ++round) {
    CHECK(solver->solve(impossible).status == QpStatus::infeasible);
    check_answer(qp, solver->solve(qp.data));
  }
}

TEST_CASE("an unbounded problem has no answer", "[solvers]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  const NamedQp qp = QpBuilder("unbounded", Eigen::MatrixXd::Zero(2, 2), vec(1, -1))
                         .box(vec(0, -kInfinity), vec(1, kInfinity))
                         .hard(vec(1, 1), 0, kInfinity);
  const QpResult result = qp_solver_factory(back_end)(qp.structure)->solve(qp.data);
  CHECK(result.status != QpStatus::solved);
  CHECK(result.status != QpStatus::infeasible);
}

TEST_CASE("every back end refuses bad problems", "[solvers]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  const NamedQp qp = find("box on a coupled Hessian");
  QpStructure lopsided = *qp.structure;
  lopsided.hessian(0, 1) += 1;
  CHECK_THROWS_AS(qp_solver_factory(back_end)(std::make_shared<QpStructure>(lopsided)), InputError);
  QpData crossed = qp.data;
  crossed.lower(1) = 1;
  CHECK_THROWS_AS(qp_solver_factory(back_end)(qp.structure)->solve(crossed), InputError);
}

TEST_CASE("an unknown back end is refused and the known ones are named", "[solvers]") {
  try {
    qp_solver_factory("simplex");
    FAIL("accepted");
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK_THAT(text, Catch::Contains("\"simplex\""));
    for (const std::string& name : qp_solver_names())
      CHECK_THAT(text, Catch::Contains(name));
  }
}

}  // namespace mpm
