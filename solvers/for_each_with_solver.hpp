#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "solvers/qp_solver.hpp"

namespace mpm {

/// Calls body(i, factory) for each i below `count`, in any order and perhaps in threads at once: no call may
/// depend on another. A call may be made again with another factory, and then the last one counts.
using ForEachWithSolver = std::function<void(
    std::size_t count, const std::function<void(std::size_t index, const QpSolverFactory& factory)>& body)>;

/// Makes the calls one after another.
inline ForEachWithSolver in_turn(QpSolverFactory factory) {
  return [factory = std::move(factory)](std::size_t count, const auto& body) {
    for (std::size_t i = 0; i < count; ++i)
      body(i, factory);
  };
}

}  // namespace mpm
