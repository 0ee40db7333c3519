#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solvers/qp.hpp"

namespace mpm::samples {

/// A quadratic program with what is known about its answer. Every back end has to get every one right.
struct NamedQp {
  std::string name;
  std::shared_ptr<const QpStructure> structure;
  QpData data;
  QpStatus expected = QpStatus::solved;
  std::optional<Eigen::VectorXd> x;  ///< the minimiser, where it is known
  bool unique = true;                ///< one minimiser only, so that back ends must agree on x
};

/// Small problems with an answer that can be worked out on paper.
std::vector<NamedQp> closed_form_qps();

/// Problems that are hard on a solver for their degeneracy rather than their size.
std::vector<NamedQp> degenerate_qps();

/// Problems without a feasible point, as `infeasible` is expected to be reported.
std::vector<NamedQp> infeasible_qps();

/// Random problems made backwards from their answer: minimiser, multipliers and active limits are drawn first
/// and gradient and limits are computed from them, so that the answer is known whatever the size.
std::vector<NamedQp> backward_qps();

/// Target problems (6.19) of P1 under random disturbances: H = 0, one linear slack a row.
std::vector<NamedQp> target_qps();

/// All of the above.
std::vector<NamedQp> qp_collection();

}  // namespace mpm::samples
