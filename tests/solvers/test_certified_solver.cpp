#include <cmath>

#include <catch2/catch.hpp>

#include "solvers/certified_solver.hpp"
#include "tests/solvers/qp_builder.hpp"
#include "tests/solvers/qp_collection.hpp"

namespace mpm {
namespace {

using samples::NamedQp;

}  // namespace

TEST_CASE("an answer is certified by its residual, a verdict of no answer by its certificate",
          "[certified_solver]") {
  QpResult result;
  result.status = QpStatus::solved;
  result.kkt_residual = kCertifiedKktResidual;
  CHECK(is_certified(result));
  result.kkt_residual = 2 * kCertifiedKktResidual;
  CHECK_FALSE(is_certified(result));
  result.status = QpStatus::infeasible;
  CHECK(is_certified(result));
  for (const QpStatus status : {QpStatus::iteration_limit, QpStatus::numerical_error}) {
    result.status = status;
    result.kkt_residual = 0.0;
    CHECK_FALSE(is_certified(result));
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
