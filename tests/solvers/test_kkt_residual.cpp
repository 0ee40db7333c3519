
#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "solvers/qp.hpp"
#include "tests/solvers/qp_builder.hpp"

// The certificate at an optimum made by hand, and after each way of spoiling it.

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

// Variables: 0 at its upper limit, 1 at its lower one, 2 free. Row 0 is x2 at its hard upper limit, row 1
// x0 + x1 above its soft upper limit by slack 0, row 2 x1 kept exactly at its soft lower limit, row 3 is
// slack.
NamedQp problem() {
  return QpBuilder("by hand", Eigen::MatrixXd::Identity(3, 3), vec(-5.5, -0.25, -2))
      .box(vec(-1, 0, -9), vec(1, 4, 9))
      .slack(1, 0.5)
      .slack(1, 2)
      .hard(vec(0, 0, 1), -3, 1)
      .soft(vec(1, 1, 0), 0, -7, 0.5)
      .soft(vec(0, 1, 0), 1, 0, 3)
      .hard(vec(1, 1, 1), -10, 10);
}

// x = (1, 0, 1). Slack 0 is 0.5 and pushes row 1 with 0.5 + 2 * 0.5 = 1.5; row 2 is pushed down by 1 < 2.
// Stationarity: x0: 1 - 5.5 + 1.5 + 3 = 0; x1: 0 - 0.25 + 1.5 - 1 - 0.25 = 0; x2: 1 - 2 + 1 = 0.
QpResult optimum(const QpStructure& structure) {
  QpResult result = QpResult::zero(structure);
  result.x = vec(1, 0, 1);
  result.slack = vec(0.5, 0);
  result.bound_dual = vec(3, -0.25, 0);
  result.hard_dual = vec(1, 0, 0, 0);
  result.soft_dual = vec(0, 1.5, -1, 0);
  return result;
}

constexpr double kScale = 5.5;  // max(1, |g|): divides stationarity and complementarity

/// The residual after `spoil` has changed the optimum.
template <typename Spoil>
double residual_after(Spoil spoil) {
  const NamedQp qp = problem();
  QpResult result = optimum(*qp.structure);
  spoil(result);
  return kkt_residual(*qp.structure, qp.data, result);
}

}  // namespace

// All numbers of the problem are exact in binary, except for the division by the scale: Approx where it
// enters.
TEST_CASE("the residual is zero at an optimum", "[kkt]") {
  CHECK(residual_after([](QpResult&) {}) == 0.0);
}

TEST_CASE("the objective counts moves and slacks", "[kkt]") {
  const NamedQp qp = problem();
  // 1/2 (1 + 1) - 5.5 - 2 + 0.25 + 0.25
  CHECK(objective(*qp.structure, qp.data, optimum(*qp.structure)) == -6.0);
}

TEST_CASE("the residual sees every variable", "[kkt]") {
  CHECK(residual_after([](QpResult& r) { r.x(0) += 0.5; }) == 0.5);    // above its limit
  CHECK(residual_after([](QpResult& r) { r.x(1) -= 0.25; }) == 0.25);  // below its limit
  CHECK(residual_after([](QpResult& r) { r.x(2) += 2; }) == 2.0);      // above the hard limit of row 0
  // Inside all limits: 0.5 away from stationarity and from the limit that row 0 pushes at.
  CHECK(residual_after([](QpResult& r) { r.x(2) -= 0.5; }) == Approx(0.5 / kScale));
}

TEST_CASE("the residual sees hard limits from both sides", "[kkt]") {
  CHECK(residual_after([](QpResult& r) { r.x(2) = -5; }) >= 2.0);  // row 0 is 2 below -3
  NamedQp qp = problem();
  qp.data.hard_lower(3) = 4;
  CHECK(kkt_residual(*qp.structure, qp.data, optimum(*qp.structure)) == 2.0);  // row 3 has the value 2
}

TEST_CASE("the residual sees every slack", "[kkt]") {
  CHECK(residual_after([](QpResult& r) { r.slack(0) = 0; }) == 0.5);  // soft limit violated by more than s
  CHECK(residual_after([](QpResult& r) { r.slack(1) = -0.25; }) == 0.25);  // s >= 0, and row 2's limit
  // Too large: row 1 pushes with 1.5 at a limit it is 0.5 away from, and its slack asks for a force of 2.5,
  // 1 more than that: 1 * s = 1 * 1.
  CHECK(residual_after([](QpResult& r) { r.slack(0) = 1; }) == Approx(1 / kScale));
  // Too large for nothing: row 2 pushes with 1 from 0.5 away, its slack lacks (2 + 2 * 0.5 - 1) of force.
  CHECK(residual_after([](QpResult& r) { r.slack(1) = 0.5; }) == Approx(2 * 0.5 / kScale));
}

TEST_CASE("the residual sees every multiplier", "[kkt]") {
  const auto k = GENERATE(0, 1, 2);
  CHECK(residual_after([k](QpResult& r) { r.bound_dual(k) += 2; }) >= 2 / kScale);
  CHECK(residual_after([k](QpResult& r) { r.bound_dual(k) -= 2; }) >= 2 / kScale);
  const auto row = GENERATE(0, 1, 2, 3);
  CHECK(residual_after([row](QpResult& r) { r.hard_dual(row) += 2; }) >= 2 / kScale);
  CHECK(residual_after([row](QpResult& r) { r.hard_dual(row) -= 2; }) >= 2 / kScale);
}

TEST_CASE("the residual sees soft multipliers", "[kkt]") {
  const auto row = GENERATE(1, 2);
  CHECK(residual_after([row](QpResult& r) { r.soft_dual(row) += 2; }) >= 2 / kScale);
  CHECK(residual_after([row](QpResult& r) { r.soft_dual(row) -= 2; }) >= 2 / kScale);
}

// Multipliers shifted so that stationarity in x stays: only the condition named can report it.
TEST_CASE("the residual sees each kind of complementarity", "[kkt]") {
  // x2 pushed by its own limit, 8 away, instead of row 0.
  CHECK(residual_after([](QpResult& r) {
          r.bound_dual(2) = 1;
          r.hard_dual(0) = 0;
        }) == Approx(8 / kScale));
  // x1 pushed by 2 more at its limit and row 2 relieved of 2: it would push its soft upper limit, 3 away.
  CHECK(residual_after([](QpResult& r) {
          r.bound_dual(1) -= 2;
          r.soft_dual(2) += 2;
        }) == Approx(3 / kScale));
  // Row 2 pushes with 3: more than its slack costs, so that a slack of zero is too dear.
  CHECK(residual_after([](QpResult& r) {
          r.bound_dual(1) += 2;
          r.soft_dual(2) -= 2;
        }) >= 1 / kScale);
  // Row 1 pushes with less than its slack in use costs: 1 too little, times a slack of 0.5.
  CHECK(residual_after([](QpResult& r) {
          r.bound_dual(0) += 1;
          r.bound_dual(1) += 0.25;
          r.hard_dual(0) += 0;
          r.soft_dual(1) -= 1;
          r.soft_dual(2) += 0.75;
        }) == Approx(0.5 / kScale));
}

TEST_CASE("a negative slack is a violation, whatever its rows do", "[kkt]") {
  const NamedQp qp = QpBuilder("unused slack", Eigen::MatrixXd::Identity(1, 1), vec(0)).slack(0, 0.125);
  QpResult result = QpResult::zero(*qp.structure);
  result.slack(0) = -0.25;
  CHECK(kkt_residual(*qp.structure, qp.data, result) == 0.25);
}

TEST_CASE("nothing may push at an absent limit", "[kkt]") {
  const NamedQp qp = QpBuilder("free", Eigen::MatrixXd::Identity(1, 1), vec(0))
                         .slack(0, 1)
                         .soft(vec(1), 0, -kInfinity, kInfinity);
  QpResult result = QpResult::zero(*qp.structure);
  result.soft_dual(0) = 0.5;
  result.bound_dual(0) = -0.5;
  CHECK(kkt_residual(*qp.structure, qp.data, result) == 0.5);
}

TEST_CASE("an answer that is not finite is no answer", "[kkt]") {
  for (const double bad : {kNaN, kInfinity}) {
    CHECK(residual_after([bad](QpResult& r) { r.x(2) = bad; }) == kInfinity);
    CHECK(residual_after([bad](QpResult& r) { r.slack(0) = bad; }) == kInfinity);
    CHECK(residual_after([bad](QpResult& r) { r.bound_dual(0) = bad; }) == kInfinity);
    CHECK(residual_after([bad](QpResult& r) { r.hard_dual(3) = bad; }) == kInfinity);
    CHECK(residual_after([bad](QpResult& r) { r.soft_dual(1) = bad; }) == kInfinity);
  }
}

}  // namespace mpm
