#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "solvers/active_set_certificate.hpp"
#include "solvers/active_set_correction.hpp"
#include "solvers/active_set_curvature.hpp"
#include "solvers/active_set_factor.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_schur.hpp"
#include "tests/solvers/qp_builder.hpp"

// The linear algebra below the active-set back end, against Eigen's or against a plain sum.

namespace mpm {
namespace {

using samples::QpBuilder;
using samples::vec;

// Well-conditioned matrices of a dozen rows: a few hundred roundings.
constexpr double kRounding = 1e-12;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&] { return static_cast<double>(generator()) / 2147483648.0 - 1.0; });
}

Eigen::MatrixXd random_definite(Eigen::Index size, unsigned seed) {
  const Eigen::MatrixXd root = random_matrix(size, size, seed);
  return root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
}

// As the factor takes it: beside the matrix, columns of the unit matrix.
LaneMatrix lane_matrix(const Eigen::MatrixXd& matrix) {
  LaneMatrix result(matrix.rows(), padded(matrix.rows()));
  for (Eigen::Index j = 0; j < result.columns(); ++j)
    for (Eigen::Index i = 0; i < result.stride(); ++i)
      result(i, j) = std::max(i, j) < matrix.rows() ? matrix(i, j) : i == j ? 1.0 : 0.0;
  return result;
}

}  // namespace

TEST_CASE("the factor of a principal submatrix solves with it", "[active-set]") {
  const Eigen::MatrixXd matrix = random_definite(13, 1);
  const std::vector<int> free = GENERATE(
      std::vector<int>{}, std::vector<int>{4}, std::vector<int>{0, 2, 3, 5, 7, 11, 12},
      std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}, std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  ActiveSetFactor factor(13);
  REQUIRE(factor.compute(lane_matrix(matrix), free));
  const Eigen::VectorXd right = random_matrix(13, 1, 2);
  LaneVector solution(right);
  LaneVector packed(13);
  factor.pack(solution, packed.data());
  factor.solve_lower(packed.data());
  factor.solve_upper(packed.data());
  factor.unpack(packed.data(), solution);

  const Eigen::VectorXd x = solution.vector();
  const Eigen::VectorXd expected = matrix(free, free).llt().solve(right(free));
  CHECK((x(free) - expected).norm() <= kRounding);
  for (int j = 0; j < 13; ++j)
    if (std::find(free.begin(), free.end(), j) == free.end())
      CHECK(x(j) == right(j));
}

TEST_CASE("a matrix that is not positive definite has no factor", "[active-set]") {
  Eigen::MatrixXd matrix = random_definite(6, 3);
  matrix.row(4) = matrix.row(1);
  matrix.col(4) = matrix.col(1);
  ActiveSetFactor factor(6);
  CHECK_FALSE(factor.compute(lane_matrix(matrix), {0, 1, 2, 3, 4, 5}));
  CHECK(factor.compute(lane_matrix(matrix), {0, 1, 2, 3, 5}));
}

TEST_CASE("a Schur factor grows and shrinks", "[active-set]") {
  const Eigen::MatrixXd matrix = random_definite(9, 4);
  std::vector<int> present;
  SchurFactor factor(9);
  const auto append = [&](int j) {
    Eigen::VectorXd column = matrix.col(j)(present);
    factor.solve_lower(column);
    REQUIRE(factor.append(column, matrix(j, j) - column.squaredNorm()));
    present.push_back(j);
  };
  const auto remove = [&](std::size_t k) {
    factor.remove(static_cast<Eigen::Index>(k));
    present.erase(present.begin() + static_cast<std::ptrdiff_t>(k));
  };
  for (const int j : {3, 7, 0, 5, 8, 1})
    append(j);
  for (const std::size_t k : {0U, 2U, 3U})
    remove(k);
  append(6);
  append(3);

  const Eigen::VectorXd right = random_matrix(static_cast<Eigen::Index>(present.size()), 1, 5);
  Eigen::VectorXd x = right;
  factor.solve_in_place(x);
  CHECK((matrix(present, present) * x - right).norm() <= kRounding);
}

TEST_CASE("a Schur factor refuses a row of which nothing is left, and a row too many", "[active-set]") {
  SchurFactor factor(2);
  REQUIRE(factor.append(Eigen::VectorXd(0), 4.0));
  CHECK_FALSE(factor.append(vec(3), 0.0));
  CHECK_FALSE(factor.append(vec(3), kNaN));
  REQUIRE(factor.append(vec(0), 1.0));
  CHECK_FALSE(factor.append(vec(0, 0), 1.0));
  CHECK(factor.size() == 2);
}

TEST_CASE("the curvature follows the springs", "[active-set]") {
  QpBuilder builder("curvature", random_definite(5, 6), Eigen::VectorXd::Zero(5));
  const Eigen::MatrixXd rows = random_matrix(8, 5, 7);
  builder.slack(2.5, 0.5);  // shared by rows 4 to 7: kept as a variable
  for (int i = 0; i < 4; ++i)
    builder.slack(1.0 + i, 0.0).soft(rows.row(i), i + 1, -1, 1);
  for (int i = 4; i < 8; ++i)
    builder.soft(rows.row(i), 0, -1, 1);
  const samples::NamedQp qp = builder.build();
  const ActiveSetProblem problem(*qp.structure);
  REQUIRE(problem.variable_count() == 6);

  std::vector<LimitSprings> families;
  families.emplace_back(0.0, problem.softness);
  families.emplace_back(-1.0, (problem.slack_column.array() >= 0).select(problem.limit_stiffness, 0.0));
  ActiveSetCurvature curvature(problem, families.size());

  std::mt19937 generator(8);
  int corrections = 0;
  for (int round = 0; round < 20; ++round) {
    Eigen::MatrixXd expected = problem.quadratic;
    for (LimitSprings& springs : families) {
      LaneVector value(springs.size());
      for (Eigen::Index i = 0; i < springs.size(); ++i) {
        springs.lower(i) = -1.0;
        springs.upper(i) = 1.0;
        value(i) = springs.stiffness(i) > 0 && generator() % 2 == 0 ? 2.0 : 0.0;
        Eigen::VectorXd normal = Eigen::VectorXd::Zero(6);
        normal.head(5) = qp.structure->rows.row(i).transpose();
        if (problem.slack_column(i) >= 0)
          normal(problem.slack_column(i)) = springs.slack_sign;
        if (value(i) > 1.0)
          expected += springs.stiffness(i) * normal * normal.transpose();
      }
      springs.place(problem, value, LaneVector(6));
      springs.pull();
    }
    std::vector<SpringChange> changes;
    const bool few = curvature.find_few(families, changes);
    Eigen::MatrixXd corrected = Eigen::MatrixXd::Zero(6, 6);
    for (Eigen::Index j = 0; j < 6; ++j)
      corrected.col(j).tail(6 - j) =
          Eigen::Map<const Eigen::VectorXd>(curvature.matrix().column(j) + j, 6 - j);
    for (const SpringChange& change : changes) {
      LaneVector normal(6);
      problem.write_normal(change.row, change.slack_sign, normal);
      corrected += change.weight * normal.vector() * normal.vector().transpose();
    }
    if (few) {
      ++corrections;
      corrected.triangularView<Eigen::StrictlyUpper>() = expected;
      CHECK((corrected - expected).norm() <= kRounding * expected.norm());
    }
    curvature.synchronise(families);
    CHECK_FALSE(curvature.synchronise(families));
    CHECK((curvature.find_few(families, changes) && changes.empty()));
    for (Eigen::Index j = 0; j < 6; ++j)
      for (Eigen::Index i = j; i < 6; ++i)
        CHECK(std::abs(curvature.matrix()(i, j) - expected(i, j)) <= kRounding * expected.norm());
  }
  CHECK(corrections > 5);
}

TEST_CASE("a factor is corrected for a few springs", "[active-set]") {
  constexpr int kRows = 12;
  const Eigen::MatrixXd hessian = random_definite(9, 11);
  const Eigen::MatrixXd rows = random_matrix(kRows, 9, 12);
  QpBuilder builder("correction", hessian, Eigen::VectorXd::Zero(9));
  builder.slack(2.5, 0.5);  // shared: kept as variable 9
  for (int i = 0; i < kRows; ++i)
    builder.soft(rows.row(i), 0, -1, 1);
  const samples::NamedQp qp = builder.build();
  const ActiveSetProblem problem(*qp.structure);
  const std::vector<int> free{0, 1, 3, 4, 6, 7, 8, 9};
  const Eigen::VectorXd right = random_matrix(10, 1, 13);
  const auto normal = [&](int row) {
    Eigen::VectorXd result(10);
    result << rows.row(row).transpose(), 1.0;
    return result;
  };

  // What the factor has: rows 0 to 5 with the stiffness 3.
  Eigen::MatrixXd present = problem.quadratic;
  for (int i = 0; i < 6; ++i)
    present += 3.0 * normal(i) * normal(i).transpose();
  ActiveSetFactor factor(10);
  REQUIRE(factor.compute(lane_matrix(present), free));
  ActiveSetCorrection correction(problem, factor);

  // One call after the other, so that columns stay, come and go.
  for (const std::vector<int>& changed :
       {std::vector<int>{}, {7}, {1, 7, 9}, {1, 4, 9, 11}, {0, 1, 2, 3, 6, 7, 8, 9}, {5}, {}, {2, 10}}) {
    std::vector<SpringChange> changes;
    Eigen::MatrixXd wanted = present;
    for (const int row : changed) {
      changes.push_back({row, 1.0, row < 6 ? -3.0 : 3.0});
      wanted += changes.back().weight * normal(row) * normal(row).transpose();
    }
    REQUIRE(correction.assign(changes));
    LaneVector x(right);
    correction.solve_in_place(x);
    const Eigen::VectorXd solution = x.vector();
    const Eigen::VectorXd expected = wanted(free, free).llt().solve(right(free));
    CHECK((solution(free) - expected).norm() <= kRounding);
    CHECK(solution(2) == right(2));
  }

  // More than it takes, and a matrix that would not be definite: then the factor is as it was.
  std::vector<SpringChange> many;
  for (int row = 0; row < 9; ++row)
    many.push_back({row, 1.0, row < 6 ? -3.0 : 3.0});
  for (const std::vector<SpringChange>& refused : {many, {{7, 1.0, -1e3}}}) {
    CHECK_FALSE(correction.assign(refused));
    LaneVector x(right);
    correction.solve_in_place(x);
    const Eigen::VectorXd solution = x.vector();
    CHECK((solution(free) - present(free, free).llt().solve(right(free))).norm() <= kRounding);
  }
}

TEST_CASE("the proven violation of two opposed rows", "[active-set]") {
  // x >= 3 as a row within x <= 1: every x violates it by at least 2.
  const samples::NamedQp qp = QpBuilder("opposed", Eigen::MatrixXd::Identity(2, 2), vec(0, 0))
                                  .box(vec(-1, -1), vec(1, 1))
                                  .hard(vec(1, 0), 3, 9)
                                  .build();
  Eigen::VectorXd scratch(2);
  CHECK(proven_violation(*qp.structure, qp.data, vec(-5), scratch) == Approx(2.0));
  CHECK(proven_violation(*qp.structure, qp.data, vec(5), scratch) < 0);  // says nothing: -1 >= 9 is far
  CHECK(proven_violation(*qp.structure, qp.data, vec(0), scratch) < 0);
}

TEST_CASE("where x has no limit only exact combinations prove anything", "[active-set]") {
  const samples::NamedQp qp = QpBuilder("opposed", Eigen::MatrixXd::Identity(2, 2), vec(0, 0))
                                  .hard(vec(1, 1), 3, 9)
                                  .hard(vec(1, 1), -9, 2)
                                  .build();
  Eigen::VectorXd scratch(2);
  CHECK(proven_violation(*qp.structure, qp.data, vec(-1, 1), scratch) == Approx(0.5));
  CHECK(std::isinf(proven_violation(*qp.structure, qp.data, vec(-1, 1.001), scratch)));
}

}  // namespace mpm
