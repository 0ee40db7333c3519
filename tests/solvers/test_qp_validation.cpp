#include <string>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/qp.hpp"
#include "tests/solvers/qp_builder.hpp"

// Every refusal of QpStructure::validate and QpData::validate, by the quantity it has to name.

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

NamedQp valid_problem() {
  return QpBuilder("valid", Eigen::MatrixXd::Identity(2, 2), vec(0, 0))
      .slack(1, 0)
      .slack(0, 1)
      .soft(vec(1, 1), 0, 0, 1)
      .soft(vec(1, 2), 1, 0, 1)
      .hard(vec(1, -1), -1, 1);
}

/// What validate() says after `spoil`; empty when it accepts.
template <typename Spoil>
std::string refusal_of_structure(Spoil spoil) {
  QpStructure structure = *valid_problem().structure;
  spoil(structure);
  try {
    structure.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

template <typename Spoil>
std::string refusal_of_data(Spoil spoil) {
  const NamedQp qp = valid_problem();
  QpData data = qp.data;
  spoil(data);
  try {
    data.validate(*qp.structure);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Catch::StartsWith;

}  // namespace

TEST_CASE("valid problems pass", "[qp]") {
  CHECK(refusal_of_structure([](QpStructure&) {}).empty());
  CHECK(refusal_of_data([](QpData&) {}).empty());
  CHECK(refusal_of_data([](QpData& d) { d.lower = d.upper = vec(1, 2); }).empty());
  CHECK(refusal_of_structure([](QpStructure& s) {
          s = QpStructure{};
          s.hessian.setIdentity(2, 2);
          s.rows.resize(0, 2);
        }).empty());
}

TEST_CASE("structures of the wrong shape are refused", "[qp]") {
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.hessian.setZero(2, 3); }),
             StartsWith("QP hessian (columns)"));
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.rows.setZero(3, 1); }),
             StartsWith("QP rows (columns)"));
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.rows.resize(0, 0), s.slack_of_row.resize(0); }),
             StartsWith("QP rows (columns)"));
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.slack_of_row.setZero(2); }),
             StartsWith("QP slack_of_row"));
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.slack_linear.setOnes(1); }),
             StartsWith("QP slack_linear"));
}

TEST_CASE("structures with bad numbers are refused", "[qp]") {
  for (const double bad : {kNaN, kInfinity}) {
    CHECK_THAT(refusal_of_structure([bad](QpStructure& s) { s.hessian(1, 1) = bad; }),
               StartsWith("QP hessian and rows"));
    CHECK_THAT(refusal_of_structure([bad](QpStructure& s) { s.rows(2, 0) = bad; }),
               StartsWith("QP hessian and rows"));
  }
  CHECK_THAT(refusal_of_structure([](QpStructure& s) { s.hessian(0, 1) = 1e-9; }),
             StartsWith("QP hessian: found an unsymmetric"));
}

TEST_CASE("structures with bad slacks are refused", "[qp]") {
  for (const double bad : {-1.0, kNaN, kInfinity, 0.0}) {
    CHECK_THAT(refusal_of_structure([bad](QpStructure& s) { s.slack_quadratic(0) = bad; }),
               StartsWith("QP slack weights[0]"));
    CHECK_THAT(refusal_of_structure([bad](QpStructure& s) { s.slack_linear(1) = bad; }),
               StartsWith("QP slack weights[1]"));
  }
  for (const int bad : {-2, 2})
    CHECK_THAT(refusal_of_structure([bad](QpStructure& s) { s.slack_of_row(1) = bad; }),
               StartsWith("QP slack_of_row[1]"));
}

TEST_CASE("data of the wrong shape are refused", "[qp]") {
  CHECK_THAT(refusal_of_data([](QpData& d) { d.gradient = vec(1); }), StartsWith("QP gradient"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.lower = vec(1); }), StartsWith("QP lower"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.upper = vec(1); }), StartsWith("QP upper"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.hard_lower = vec(1); }), StartsWith("QP hard_lower"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.hard_upper = vec(1); }), StartsWith("QP hard_upper"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.soft_lower = vec(1); }), StartsWith("QP soft_lower"));
  CHECK_THAT(refusal_of_data([](QpData& d) { d.soft_upper = vec(1); }), StartsWith("QP soft_upper"));
}

TEST_CASE("a gradient that is not finite is refused", "[qp]") {
  for (const double bad : {kNaN, kInfinity})
    CHECK_THAT(refusal_of_data([bad](QpData& d) { d.gradient(1) = bad; }), StartsWith("QP gradient"));
}

TEST_CASE("limits that cross, are no number or shut everything out are refused", "[qp]") {
  // (lower, upper) of the element with index 1.
  const auto [lower, upper] = GENERATE(table<double, double>(
      {{1, 0}, {kNaN, 1}, {0, kNaN}, {kInfinity, kInfinity}, {-kInfinity, -kInfinity}, {kInfinity, 0}}));
  const double low = lower;
  const double high = upper;
  CHECK_THAT(refusal_of_data([=](QpData& d) { d.lower(1) = low, d.upper(1) = high; }),
             StartsWith("QP limits of x[1]"));
  CHECK_THAT(refusal_of_data([=](QpData& d) { d.hard_lower(1) = low, d.hard_upper(1) = high; }),
             StartsWith("QP hard limits[1]"));
  CHECK_THAT(refusal_of_data([=](QpData& d) { d.soft_lower(1) = low, d.soft_upper(1) = high; }),
             StartsWith("QP soft limits[1]"));
}

TEST_CASE("statuses have names", "[qp]") {
  CHECK(to_string(QpStatus::solved) == "solved");
  CHECK(to_string(QpStatus::infeasible) == "infeasible");
  CHECK(to_string(QpStatus::iteration_limit) == "iteration limit");
  CHECK(to_string(QpStatus::numerical_error) == "numerical error");
}

}  // namespace mpm
