
#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "solvers/working_set.hpp"
#include "tests/solvers/qp_builder.hpp"

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

// In one variable: row 0 hard, rows 1 and 2 share slack 0, row 3 has no limits but a slack of its own.
NamedQp working_set_problem() {
  return QpBuilder("rows", Eigen::MatrixXd::Identity(1, 1), vec(0))
      .slack(1, 0)
      .slack(1, 0)
      .hard(vec(1), -1, 1)
      .soft(vec(1), 0, -2, 2)
      .soft(vec(2), 0, -kInfinity, 3)
      .soft(vec(1), 1, -kInfinity, kInfinity);
}

int added(WorkingSet& set, const NamedQp& qp, double x, double slack, double margin = 0.0) {
  return set.add_violated(*qp.structure, qp.data, vec(x), vec(slack, 0), margin, 1e-9);
}

}  // namespace

TEST_CASE("the full set has every limit that exists", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  set.fill(*qp.structure, qp.data);
  REQUIRE(set.rows().size() == 4);  // hard 0, both sides of 1, the upper one of 2
  CHECK(set.slacks() == std::vector<int>{0});
  CHECK(set.slack_position(0) == 0);
  CHECK(set.slack_position(1) == -1);
  set.clear();
  CHECK(set.rows().empty());
  CHECK(set.slacks().empty());
  CHECK(set.slack_position(0) == -1);
}

TEST_CASE("a kept limit does not enter", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  CHECK(added(set, qp, 0.5, 0) == 0);
  CHECK(set.rows().empty());
}

TEST_CASE("violated limits enter once, with the side that is violated", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  CHECK(added(set, qp, 2.5, 0) == 3);  // hard 0, upper 1, upper 2 (value 5)
  REQUIRE(set.rows().size() == 3);
  CHECK(set.rows()[0].side == RowSide::hard);
  CHECK(set.rows()[1].side == RowSide::soft_upper);
  CHECK(set.rows()[2].row == 2);
  CHECK(set.slacks() == std::vector<int>{0});
  CHECK(added(set, qp, 2.5, 0) == 0);
  CHECK(added(set, qp, -2.5, 0) == 1);  // the lower side of row 1; the hard row has both sides in already
  CHECK(set.rows().back().side == RowSide::soft_lower);
}

TEST_CASE("a shared slack relaxes the rows that are left out too", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  CHECK(added(set, qp, 2.5, 2.5) == 1);  // only the hard row: row 1 and row 2 are within their slack
  CHECK(set.rows().size() == 1);
  CHECK(added(set, qp, 2.5, 1.0) == 1);   // row 2: 5 > 3 + 1
  CHECK(added(set, qp, -2.5, 1.0) == 0);  // row 1 is below -2 by less than its slack
  CHECK(added(set, qp, -2.5, 0.25) == 1);
}

TEST_CASE("the margin lets near limits in without counting them", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  CHECK(added(set, qp, 0.95, 0, 0.1) == 0);
  REQUIRE(set.rows().size() == 1);
  CHECK(set.rows()[0].row == 0);
}

TEST_CASE("the limits that push in an answer enter, on the side they push from", "[working_set]") {
  const NamedQp qp = working_set_problem();
  WorkingSet set(*qp.structure);
  QpResult answer = QpResult::zero(*qp.structure);
  answer.soft_dual(1) = -2.0;  // lower limit of row 1
  answer.soft_dual(2) = 1e-9;  // next to nothing
  answer.hard_dual(0) = 1.0;
  set.add_active(*qp.structure, qp.data, answer, 1e-6);
  REQUIRE(set.rows().size() == 2);
  CHECK(set.rows()[0].row == 0);
  CHECK(set.rows()[0].side == RowSide::hard);
  CHECK(set.rows()[1].row == 1);
  CHECK(set.rows()[1].side == RowSide::soft_lower);
  CHECK(set.slacks() == std::vector<int>{0});
}

}  // namespace mpm
