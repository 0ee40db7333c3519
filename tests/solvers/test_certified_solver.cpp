#include <cmath>

#include <catch2/catch.hpp>

#include "solvers/certified_solver.hpp"
#include "tests/solvers/qp_builder.hpp"
#include "tests/solvers/qp_collection.hpp"

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;

/// Says that the upper limit of its only variable is the answer, but misses it by what it was told.
class MissingSolver final : public QpSolver {
 public:
  MissingSolver(const NamedQp& qp, double by) : QpSolver(qp.structure), by_(by) {}

 private:
  void do_solve(const QpData& data, QpResult& result) override {
    result.status = QpStatus::solved;
    result.x = data.upper.array() + by_;
    result.bound_dual = -(structure().hessian * result.x + data.gradient);
  }
  void do_reset() override {}

  double by_;
};

QpResult missing(double limit, double by) {
  const NamedQp qp = QpBuilder("missed", Eigen::MatrixXd::Identity(1, 1), samples::vec(-2.0 * limit))
                         .box(samples::vec(0.0), samples::vec(limit));
  return MissingSolver(qp, by).solve(qp.data);
}

}  // namespace

TEST_CASE("an answer is certified by its residual, beside the rounding of its numbers",
          "[certified_solver]") {
  const auto [limit, certified, solved] = GENERATE(table<double, double, double>({
      {1.0, 0.9 * kCertifiedKktResidual, 1.1 * kCertifiedKktResidual},
      {1e7, 0.9e7 * kAnswerRounding, 1.1e7 * kAnswerRounding},
  }));
  CAPTURE(limit);
  for (const double by : {certified, solved}) {
    const QpResult result = missing(limit, by);
    CHECK(result.status == QpStatus::solved);
    CHECK(result.certified == (by == certified));
    CHECK(is_certified(result) == result.certified);
  }
  const QpResult wrong = missing(limit, 2.0 * kSolvedKktResidual);
  CHECK(wrong.status == QpStatus::numerical_error);
  CHECK_FALSE(wrong.certified);
}

TEST_CASE("a verdict of no answer is certified by its proof, and one of the solver's never",
          "[certified_solver]") {
  QpResult result;
  for (const QpStatus status : {QpStatus::infeasible, QpStatus::iteration_limit, QpStatus::numerical_error}) {
    result.status = status;
    CHECK(is_certified(result) == (status == QpStatus::infeasible));
  }
}

TEST_CASE("certified answers are the active-set method's, bit for bit, and the others Ipopt's",
          "[certified_solver]") {
  int references = 0;
  for (const NamedQp& qp : samples::qp_collection()) {
    INFO(qp.name);
    ActiveSetSolver active_set(qp.structure, {});
    const QpResult alone = active_set.solve(qp.data);
    const QpResult result = CertifiedSolver(qp.structure).solve(qp.data);
    CHECK(result.from_ipopt == !is_certified(alone));
    CHECK(to_string(result.status) == to_string(qp.expected));
    KktWorkspace workspace(*qp.structure);
    CHECK(result.objective == objective(*qp.structure, qp.data, result));
    if (result.status == QpStatus::solved)
      CHECK(result.kkt_residual == kkt_residual(*qp.structure, qp.data, result, workspace));
    else
      CHECK(std::isinf(result.kkt_residual));
    if (result.from_ipopt)
      ++references;
    else
      CHECK(result.x == alone.x);
  }
  CAPTURE(references);
  CHECK(references < 5);  // the fast method is to answer nearly everything
}

// The active-set method has no answer to an unbounded problem, and neither has Ipopt: it is asked, and says
// so.
TEST_CASE("what the active-set method does not answer goes to Ipopt", "[certified_solver]") {
  const NamedQp qp = samples::QpBuilder("unbounded", Eigen::MatrixXd::Zero(1, 1), samples::vec(1));
  const QpResult result = CertifiedSolver(qp.structure).solve(qp.data);
  CHECK(result.from_ipopt);
  CHECK(result.status != QpStatus::solved);
  CHECK(result.status != QpStatus::infeasible);
}

}  // namespace mpm
