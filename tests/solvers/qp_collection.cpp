#include "tests/solvers/qp_collection.hpp"

#include "base/non_finite.hpp"
#include "tests/solvers/qp_builder.hpp"

namespace mpm::samples {
namespace {

Eigen::MatrixXd identity(Eigen::Index n) {
  return Eigen::MatrixXd::Identity(n, n);
}

Eigen::MatrixXd no_curvature(Eigen::Index n) {
  return Eigen::MatrixXd::Zero(n, n);
}

Eigen::MatrixXd coupled() {
  Eigen::MatrixXd hessian(2, 2);
  hessian << 4, 1, 1, 2;
  return hessian;
}

}  // namespace

std::vector<NamedQp> closed_form_qps() {
  const Eigen::VectorXd one = vec(1);
  const Eigen::VectorXd e1 = vec(1, 0);
  const Eigen::VectorXd e2 = vec(0, 1);
  const Eigen::VectorXd sum = vec(1, 1);
  return {
      // Hx = -g: 4a + b = 1, a + 2b = 2.
      QpBuilder("unconstrained", coupled(), vec(-1, -2)).answer(vec(0, 1)),
      QpBuilder("projection onto a box", identity(4), vec(-3, 0.25, 3, -0.5))
          .box(vec(-1, -1, -1, -0.5), vec(1, 1, 1, 0.5))
          .answer(vec(1, -0.25, -1, 0.5)),
      // b at 0.5: 4a + 0.5 = 1.
      QpBuilder("box on a coupled Hessian", coupled(), vec(-1, -2))
          .box(vec(-kInfinity, -kInfinity), vec(kInfinity, 0.5))
          .answer(vec(0.125, 0.5)),
      QpBuilder("nearest point of a line", identity(2), vec(0, 0)).hard(sum, 1, 1).answer(vec(0.5, 0.5)),
      QpBuilder("nearest point of a half plane", identity(2), vec(0, 0))
          .hard(vec(3, 4), 5, kInfinity)
          .answer(vec(0.6, 0.8)),
      // (h + 2w) x = 2wc for 1/2 h x^2 + w s^2, x >= c - s; h = 1, w = 2, c = 1.
      QpBuilder("quadratic slack", identity(1), vec(0))
          .slack(2, 0)
          .soft(one, 0, 1, kInfinity)
          .answer(vec(0.8)),
      QpBuilder("quadratic slack at an upper limit", identity(1), vec(0))
          .slack(2, 0)
          .soft(one, 0, -kInfinity, -1)
          .answer(vec(-0.8)),
      // The multiplier of x >= 1 - s is x: below the price the limit is kept, else x stops at the price.
      QpBuilder("linear slack dear", identity(1), vec(0))
          .slack(0, 3)
          .soft(one, 0, 1, kInfinity)
          .answer(vec(1)),
      QpBuilder("linear slack cheap", identity(1), vec(0))
          .slack(0, 0.25)
          .soft(one, 0, 1, kInfinity)
          .answer(vec(0.25)),
      // x = l + 2 w s, s = 1 - x: x = (l + 2w)/(1 + 2w) with l = 0.25, w = 0.5.
      QpBuilder("linear and quadratic slack", identity(1), vec(0))
          .slack(0.5, 0.25)
          .soft(one, 0, 1, kInfinity)
          .answer(vec(0.625)),
      // x = (1 - s, 2 - s), s = 3 / (2 + 2w), w = 2.
      QpBuilder("shared slack, both rows active", identity(2), vec(0, 0))
          .slack(2, 0)
          .soft(e1, 0, 1, kInfinity)
          .soft(e2, 0, 2, kInfinity)
          .answer(vec(0.5, 1.5)),
      // s = 4 - b for the second row only: b = 4 * 0.5 / 1.5; the first row's limit of 1 is then within s.
      QpBuilder("shared slack, the second row rides for free", identity(2), vec(0, 0))
          .slack(0.25, 0)
          .soft(e1, 0, 1, kInfinity)
          .soft(e2, 0, 4, kInfinity)
          .answer(vec(0, 4.0 / 3)),
      // A setpoint: s = |x - 2| with w = 1: 3x = 4; in the next problem the hard limit cuts it off.
      QpBuilder("soft setpoint", identity(1), vec(0)).slack(1, 0).soft(one, 0, 2, 2).answer(vec(4.0 / 3)),
      QpBuilder("hard limit inside the soft one", identity(1), vec(0))
          .slack(1, 0)
          .soft(one, 0, 2, kInfinity)
          .also_hard(-kInfinity, 1)
          .answer(vec(1)),
      QpBuilder("linear program", no_curvature(2), vec(-1, -2))
          .box(vec(0, 0), vec(1, 1))
          .hard(sum, -kInfinity, 1)
          .answer(vec(0, 1)),
      QpBuilder("linear program with a slack", no_curvature(1), vec(1))
          .box(vec(0), vec(0.5))
          .slack(0, 10)
          .soft(one, 0, 1, kInfinity)
          .answer(vec(0.5)),
      // Bounded by its rows alone: dropping them leaves an unbounded problem.
      QpBuilder("linear program bounded by rows", no_curvature(2), vec(1, 2))
          .hard(e1, 1, kInfinity)
          .hard(e2, -3, kInfinity)
          .answer(vec(1, -3)),
      QpBuilder("half-flat valley bounded by a soft row", Eigen::MatrixXd(vec(1, 0).asDiagonal()), vec(0, 1))
          .slack(0.5, 0)
          .soft(e2, 0, 1, kInfinity)
          .answer(vec(0, 0)),
  };
}

std::vector<NamedQp> degenerate_qps() {
  const Eigen::VectorXd e1 = vec(1, 0);
  const Eigen::VectorXd sum = vec(1, 1);
  const Eigen::VectorXd nearly_sum = vec(1, 1 + 1e-9);
  return {
      QpBuilder("limits touching the unconstrained optimum", coupled(), vec(-1, -2))
          .box(vec(0, -5), vec(3, 1))
          .hard(vec(2, 1), -kInfinity, 1)
          .slack(10, 0)
          .soft(vec(1, 3), 0, 3, 5)
          .answer(vec(0, 1)),
      QpBuilder("the same row three times", identity(2), vec(-2, -2))
          .hard(sum, -kInfinity, 1)
          .hard(sum, -kInfinity, 1)
          .hard(2 * sum, -kInfinity, 2)
          .answer(vec(0.5, 0.5)),
      QpBuilder("the same equality twice", identity(2), vec(0, 0))
          .hard(sum, 1, 1)
          .hard(sum, 1, 1)
          .answer(vec(0.5, 0.5)),
      QpBuilder("nearly parallel rows", identity(2), vec(-2, -2))
          .hard(sum, -kInfinity, 1)
          .hard(nearly_sum, -kInfinity, 1)
          .answer(vec(0.5, 0.5)),
      QpBuilder("nearly parallel soft rows", identity(2), vec(0, 0))
          .slack(1, 0)
          .slack(1, 0)
          .soft(sum, 0, 1, kInfinity)
          .soft(nearly_sum, 1, 1, kInfinity)
          .answer(vec(4.0 / 9, 4.0 / 9)),
      QpBuilder("redundant limits", identity(2), vec(-2, 0))
          .box(vec(-9, -9), vec(1, 9))
          .hard(e1, -kInfinity, 1)
          .hard(sum, -100, 100)
          .answer(vec(1, 0)),
      QpBuilder("more active rows than variables", identity(2), vec(-4, -4))
          .box(vec(-1, -1), vec(1, 1))
          .hard(sum, -kInfinity, 2)
          .hard(vec(1, 2), -kInfinity, 3)
          .hard(vec(2, 1), -kInfinity, 3)
          .answer(vec(1, 1)),
      QpBuilder("zero row with room", identity(2), vec(-1, 1)).hard(vec(0, 0), -1, 1).answer(vec(1, -1)),
      QpBuilder("zero row at its limits", identity(2), vec(-1, 1)).hard(vec(0, 0), 0, 0).answer(vec(1, -1)),
      QpBuilder("zero row that violates its soft limit", identity(2), vec(-1, 1))
          .slack(3, 1)
          .soft(vec(0, 0), 0, 2, 4)
          .answer(vec(1, -1)),
      QpBuilder("row without limits", identity(2), vec(-1, 1))
          .slack(1, 0)
          .soft(sum, 0, -kInfinity, kInfinity)
          .answer(vec(1, -1)),
      QpBuilder("one fixed variable", coupled(), vec(-1, -2))
          .box(vec(0.5, -9), vec(0.5, 9))
          .hard(sum, -kInfinity, 1)
          .answer(vec(0.5, 0.5)),
      QpBuilder("all variables fixed", coupled(), vec(-1, -2))
          .box(vec(0.5, -1), vec(0.5, -1))
          .answer(vec(0.5, -1)),
      QpBuilder("all variables fixed, rows with room", coupled(), vec(-1, -2))
          .box(vec(0.5, -1), vec(0.5, -1))
          .hard(sum, -1, 0)
          .slack(1, 0)
          .soft(sum, 0, 2, 3)
          .answer(vec(0.5, -1)),
      QpBuilder("rows that leave one point", identity(2), vec(-3, 5))
          .hard(sum, -kInfinity, 1)
          .hard(sum, 1, kInfinity)
          .hard(vec(1, -1), 0, kInfinity)
          .hard(vec(1, -1), -kInfinity, 0)
          .answer(vec(0.5, 0.5)),
      QpBuilder("linear program with an edge of minimisers", no_curvature(2), vec(1, 1))
          .box(vec(0, 0), vec(1, 1))
          .hard(sum, 1, kInfinity)
          .not_unique(),
      QpBuilder("nothing to minimise", no_curvature(2), vec(0, 0))
          .box(vec(-1, -1), vec(1, 1))
          .hard(sum, 0.5, 1)
          .not_unique(),
      QpBuilder("slack of no row", identity(1), vec(-1)).slack(1, 0).slack(0, 1).answer(vec(1)),
  };
}

std::vector<NamedQp> infeasible_qps() {
  const Eigen::VectorXd sum = vec(1, 1);
  return {
      QpBuilder("box against a hard row", identity(2), vec(0, 0))
          .box(vec(0, 0), vec(1, 1))
          .hard(sum, 3, kInfinity)
          .infeasible(),
      QpBuilder("two hard rows", identity(2), vec(1, 0))
          .hard(sum, 1, kInfinity)
          .hard(sum, -kInfinity, 0)
          .infeasible(),
      QpBuilder("two hard rows by little", identity(2), vec(1, 0))
          .hard(sum, 1 + 1e-4, kInfinity)
          .hard(sum, -kInfinity, 1)
          .infeasible(),
      QpBuilder("two equalities", identity(2), vec(1, 0)).hard(sum, 0, 0).hard(sum, 1, 1).infeasible(),
      QpBuilder("three hard rows", identity(3), vec(1, 0, -1))
          .hard(vec(1, 2, 0), -kInfinity, 0)
          .hard(vec(0, 1, -1), -kInfinity, 0)
          .hard(vec(1, 3, -1), 0.1, kInfinity)
          .infeasible(),
      QpBuilder("zero row outside its hard limits", identity(2), vec(0, 0))
          .hard(vec(0, 0), 0.1, kInfinity)
          .infeasible(),
      QpBuilder("zero row below its hard limits, soft ones aside", identity(2), vec(0, 0))
          .slack(1, 0)
          .soft(sum, 0, 5, 6)
          .hard(vec(0, 0), -kInfinity, -0.1)
          .infeasible(),
      QpBuilder("fixed variables against a hard row", identity(2), vec(0, 0))
          .box(vec(1, 1), vec(1, 1))
          .hard(sum, -kInfinity, 1)
          .infeasible(),
      QpBuilder("linear program without a point", no_curvature(2), vec(1, 1))
          .box(vec(0, 0), vec(1, 1))
          .hard(vec(1, -1), 2, kInfinity)
          .infeasible(),
      QpBuilder("soft limits do not help", identity(2), vec(0, 0))
          .box(vec(-1, -1), vec(1, 1))
          .slack(1, 1)
          .soft(sum, 0, -1, 1)
          .also_hard(-kInfinity, -2.5)
          .infeasible(),
  };
}

std::vector<NamedQp> qp_collection() {
  std::vector<NamedQp> all;
  for (const auto& part :
       {closed_form_qps(), degenerate_qps(), infeasible_qps(), backward_qps(), target_qps()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace mpm::samples
