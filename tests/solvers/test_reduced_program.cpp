#include <algorithm>

#include <catch2/catch.hpp>

#include "scenarios/random/random_stream.hpp"
#include "solvers/reduced_program.hpp"
#include "tests/solvers/qp_builder.hpp"
#include "tests/solvers/qp_collection.hpp"

// The reduced program is the same problem in other unknowns.

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

// Sums of some hundred products of numbers of about 10, in another order.
constexpr double kReductionRounding = 1e-10;

struct Reduced {
  explicit Reduced(const NamedQp& problem) : qp(problem), set(*qp.structure), program(*qp.structure) {
    set.fill(*qp.structure, qp.data);
  }

  double value(const Eigen::VectorXd& z) const {
    double sum = program.gradient().dot(z);
    for (const auto& [i, j, q] : program.hessian())
      sum += (i == j ? 0.5 : 1.0) * q * z(i) * z(j);
    return sum;
  }

  const NamedQp qp;
  WorkingSet set;
  ReducedProgram program;
};

/// A point with the least slacks that its x allows.
QpResult point_at(const NamedQp& qp, const Eigen::VectorXd& x) {
  QpResult point = QpResult::zero(*qp.structure);
  point.x = x;
  for (Eigen::Index i = 0; i < qp.structure->row_count(); ++i)
    if (const int q = qp.structure->slack_of_row(i); q >= 0) {
      const double value = qp.structure->rows.row(i).dot(x);
      point.slack(q) =
          std::max({point.slack(q), qp.data.soft_lower(i) - value, value - qp.data.soft_upper(i)});
    }
  return point;
}

Eigen::VectorXd random_point(RandomStream& random, Eigen::Index size) {
  Eigen::VectorXd x(size);
  for (double& number : x)
    number = random.uniform(-2, 2);
  return x;
}

/// x, and for each limit in the set its surplus; of problems whose slacks are all eliminated.
Eigen::VectorXd with_surplus(const Reduced& reduced, const Eigen::VectorXd& x) {
  Eigen::VectorXd z(reduced.program.variable_count());
  z.head(x.size()) = x;
  Eigen::Index column = x.size();
  for (const auto [row, side] : reduced.set.rows()) {
    if (side == RowSide::hard)
      continue;
    const double value = reduced.qp.structure->rows.row(row).dot(x);
    z(column++) = std::max(0.0, side == RowSide::soft_upper ? reduced.qp.data.soft_upper(row) - value
                                                            : value - reduced.qp.data.soft_lower(row));
  }
  REQUIRE(column == z.size());
  return z;
}

bool has_own_slacks_only(const NamedQp& qp) {
  return qp.structure->slack_count() > 0 && qp.structure->slack_linear.isZero(0.0) &&
         (qp.structure->slack_of_row.array() >= 0).count() == qp.structure->slack_count();
}

}  // namespace

TEST_CASE("eliminating slacks shifts the objective by a constant only", "[reduced_program]") {
  RandomStream random(7, 0, StreamId::excitation);
  int problems = 0;
  for (const NamedQp& qp : samples::qp_collection()) {
    if (!has_own_slacks_only(qp))
      continue;
    ++problems;
    INFO(qp.name);
    Reduced reduced(qp);
    const QpResult one = point_at(qp, random_point(random, qp.structure->variable_count()));
    const QpResult two = point_at(qp, random_point(random, qp.structure->variable_count()));
    reduced.program.assemble(reduced.set, qp.data, one);
    const double change = objective(*qp.structure, qp.data, two) - objective(*qp.structure, qp.data, one);
    const double reduced_change =
        reduced.value(with_surplus(reduced, two.x)) - reduced.value(with_surplus(reduced, one.x));
    CHECK(reduced_change == Approx(change).epsilon(kReductionRounding).margin(kReductionRounding));
    CHECK(reduced.program.start().isApprox(with_surplus(reduced, one.x), kReductionRounding));
  }
  CHECK(problems >= 3);
}

TEST_CASE("a point of the reduced program is reported with its slacks and their multipliers",
          "[reduced_program]") {
  RandomStream random(8, 0, StreamId::excitation);
  for (const NamedQp& qp : samples::qp_collection()) {
    if (!has_own_slacks_only(qp))
      continue;
    INFO(qp.name);
    Reduced reduced(qp);
    const QpResult point = point_at(qp, random_point(random, qp.structure->variable_count()));
    reduced.program.assemble(reduced.set, qp.data, point);
    const Eigen::VectorXd z = with_surplus(reduced, point.x);
    QpResult reported = QpResult::zero(*qp.structure);
    reduced.program.report(reduced.set, qp.data, z, Eigen::VectorXd::Zero(z.size()),
                           Eigen::VectorXd::Zero(reduced.program.constraint_count()), reported);
    CHECK(reported.x == point.x);
    CHECK((reported.slack - point.slack).lpNorm<Eigen::Infinity>() < kReductionRounding);
    for (Eigen::Index i = 0; i < qp.structure->row_count(); ++i)
      if (const int q = qp.structure->slack_of_row(i); q >= 0)  // stationarity in s: 2ws = |multiplier|
        CHECK(std::abs(reported.soft_dual(i)) ==
              Approx(2.0 * qp.structure->slack_quadratic(q) * reported.slack(q)));
  }
}

TEST_CASE("slacks that rows share or that cost linearly stay variables", "[reduced_program]") {
  const NamedQp qp = QpBuilder("rows", Eigen::MatrixXd::Identity(1, 1), vec(0))
                         .slack(1, 0)  // shared
                         .slack(1, 2)  // linear cost
                         .slack(3, 0)  // eliminated
                         .soft(vec(1), 0, -2, 2)
                         .soft(vec(2), 0, -3, 3)
                         .soft(vec(3), 1, -4, 4)
                         .soft(vec(4), 2, -5, 5)
                         .also_hard(-9, 9);
  Reduced reduced(qp);
  reduced.program.assemble(reduced.set, qp.data, QpResult::zero(*qp.structure));
  CHECK(reduced.program.variable_count() == 1 + 2 + 2);  // x, two slacks, the two limits of the last row
  CHECK(reduced.program.constraint_count() == 2 + 2 + 2 + 1);  // three rows with both limits, one hard row
  CHECK(reduced.program.gradient()(1) == 0.0);
  CHECK(reduced.program.lower().tail(4).isZero(0.0));
}

}  // namespace mpm
