#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "solvers/active_set_solver.hpp"
#include "solvers/equilibrated_program.hpp"
#include "tests/solvers/qp_builder.hpp"

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;

/// What makes a program hard.
struct Difficulty {
  const char* name;
  double variable_decades = 0.0;   ///< units of the variables: 10^+-this
  double row_decades = 0.0;        ///< units of the rows: 10^+-this
  double condition = 1e2;          ///< of H, in random directions
  double angle_to_equality = 1.0;  ///< of the second row
  int solved = 200;                ///< at least so many of 200
};

constexpr Eigen::Index kVariables = 6, kRows = 4;

/// A program with a known answer, made backwards from it.
struct KnownProgram {
  NamedQp qp;
  Eigen::VectorXd x,
      units;  ///< the answer where every number is of size 1, and x = units * (x of the program)
};

class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}

  double number() { return static_cast<double>(generator_()) / 2147483648.0 - 1.0; }  // [-1, 1)

  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(); });
  }

  Eigen::VectorXd powers(Eigen::Index n, double decades) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return std::pow(10.0, decades * number()); });
  }

  /// Eigenvalues from 1 down to 1 / condition, in random directions.
  Eigen::MatrixXd hessian(double condition) {
    const Eigen::MatrixXd q = matrix(kVariables, kVariables).householderQr().householderQ();
    const Eigen::VectorXd values = Eigen::VectorXd::NullaryExpr(kVariables, [&](Eigen::Index j) {
      return std::pow(condition, -static_cast<double>(j) / static_cast<double>(kVariables - 1));
    });
    const Eigen::MatrixXd h = q * values.asDiagonal() * q.transpose();
    return 0.5 * (h + h.transpose());
  }

  /// Row 0 is an equality, half of the others are active with a multiplier.
  KnownProgram program(const Difficulty& difficulty) {
    const Eigen::MatrixXd h = hessian(difficulty.condition);
    Eigen::MatrixXd a = matrix(kRows, kVariables);
    if (difficulty.angle_to_equality < 1.0)
      a.row(1) = a.row(0) + difficulty.angle_to_equality * a.row(1);
    const Eigen::VectorXd x = matrix(kVariables, 1), value = a * x;
    Eigen::VectorXd dual = Eigen::VectorXd::Zero(kRows), upper = value;
    for (Eigen::Index i = 0; i < kRows; ++i)
      if (i == 0 || number() > 0.0)
        dual(i) = i == 0 ? number() : std::abs(number());
      else
        upper(i) += 1.0 + std::abs(number());

    const Eigen::VectorXd units = powers(kVariables, difficulty.variable_decades);
    const Eigen::VectorXd row_units = powers(kRows, difficulty.row_decades);
    const Eigen::VectorXd gradient = -(h * x) - a.transpose() * dual;
    QpBuilder builder(difficulty.name, units.asDiagonal() * h * units.asDiagonal(),
                      units.cwiseProduct(gradient));
    for (Eigen::Index i = 0; i < kRows; ++i)
      builder.hard(row_units(i) * a.row(i).transpose().cwiseProduct(units),
                   i == 0 ? row_units(i) * upper(i) : -kInfinity, row_units(i) * upper(i));
    return {builder.build(), x, units};
  }

 private:
  std::mt19937 generator_;
};

}  // namespace

// Of 200, without a second try in other units, 184 ("units 10^2.25") and 15 ("units 10^4.5") had an answer.
TEST_CASE("badly scaled programs have answers", "[active-set]") {
  const auto difficulty = GENERATE(
      Difficulty{.name = "none"}, Difficulty{.name = "units 10^2.25", .variable_decades = 2.25},
      Difficulty{.name = "units 10^4.5", .variable_decades = 4.5},
      Difficulty{.name = "rows 10^4.5", .row_decades = 4.5},
      Difficulty{.name = "units and rows 10^4.5", .variable_decades = 4.5, .row_decades = 4.5},
      Difficulty{.name = "condition 1e9", .condition = 1e9},
      Difficulty{
          .name = "condition 1e9, units 10^4.5", .variable_decades = 4.5, .condition = 1e9, .solved = 190},
      Difficulty{.name = "1e-6 from an equality", .angle_to_equality = 1e-6},
      Difficulty{.name = "1e-8 from an equality", .angle_to_equality = 1e-8},
      Difficulty{.name = "1e-8 from an equality, units and rows 10^4.5",
                 .variable_decades = 4.5,
                 .row_decades = 4.5,
                 .angle_to_equality = 1e-8,
                 .solved = 190});
  INFO(difficulty.name);
  int solved = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const KnownProgram known = Draw(seed).program(difficulty);
    const QpResult result = ActiveSetSolver(known.qp.structure, {}).solve(known.qp.data);
    if (result.status != QpStatus::solved)
      continue;
    ++solved;
    if (difficulty.condition < 1e3 && difficulty.angle_to_equality == 1.0)  // else x is hardly determined
      REQUIRE((result.x.cwiseProduct(known.units) - known.x).lpNorm<Eigen::Infinity>() <= 1e-8);
  }
  CHECK(solved >= difficulty.solved);
}

TEST_CASE("a badly scaled program without a feasible point is proven infeasible", "[active-set]") {
  QpBuilder builder("empty", Eigen::MatrixXd(vec(1e8, 1e-6).asDiagonal()), vec(1e4, 1e-3));
  builder.hard(vec(1e4, 1e-3), -kInfinity, -1.0).hard(vec(2e4, 2e-3), 2.0, kInfinity);
  const NamedQp qp = builder.build();
  CHECK(ActiveSetSolver(qp.structure, {}).solve(qp.data).status == QpStatus::infeasible);
}

TEST_CASE("a program in other units is the same program", "[equilibrated]") {
  QpBuilder builder("units", Eigen::MatrixXd(vec(4e8, 0.0).asDiagonal()), vec(1.0, 2.0));
  builder.box(vec(-1e-4, -1.0), vec(1e-4, 1.0)).slack(3.0, 5.0);
  builder.soft(vec(1e4, 1e3), 0, -1.0, 1.0).soft(vec(1e2, 0.0), 0, -1.0, 2.0).hard(vec(0.0, 1e6), -7.0, 7.0);
  const NamedQp qp = builder.build();
  EquilibratedProgram program(*qp.structure);
  const QpStructure& scaled = *program.structure();
  CHECK(scaled.hessian.diagonal().maxCoeff() <= 2.0);
  CHECK(scaled.hessian.diagonal().maxCoeff() >= 0.5);
  CHECK(scaled.rows.rowwise().norm().maxCoeff() <= 2.0);

  // Any point costs the same in either units, and keeps or breaks its limits by as much of a row's unit.
  QpResult there = QpResult::zero(scaled), here = QpResult::zero(*qp.structure);
  there.x = vec(0.3, -0.2);
  there.slack = vec(0.7);
  program.write_back(there, here);
  CHECK(objective(*qp.structure, qp.data, here) == Approx(objective(scaled, program.scaled(qp.data), there)));
  const Eigen::VectorXd share_here = (qp.structure->rows * here.x).cwiseQuotient(qp.data.hard_upper);
  const Eigen::VectorXd share_there =
      (scaled.rows * there.x).cwiseQuotient(program.scaled(qp.data).hard_upper);
  CHECK(share_here(2) == Approx(share_there(2)));
  CHECK((here.x - vec(0.3, -0.2)).norm() > 0.1);
}

}  // namespace mpm
