#pragma once

#include <memory>

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// DAQP (github.com/darnstrom/daqp, a dual active-set method in C) on the programs of one sequence, warm: it
/// has one workspace, in which only gradient and limits change.
///
/// A slack that belongs to one row is DAQP's own soft constraint with the row's weight; shared slacks are
/// variables, and each soft limit is a row of its own. The hard limits of the rows are left out, to its
/// advantage.
class DaqpRival {
 public:
  /// `structure` must outlive this. Throws InputError if DAQP does not accept it.
  explicit DaqpRival(const QpStructure& structure);
  ~DaqpRival();
  DaqpRival(const DaqpRival&) = delete;
  DaqpRival& operator=(const DaqpRival&) = delete;

  /// Forgets the active set.
  void reset();
  /// Solves a program. Returns the seconds that DAQP took, without the time to copy the limits.
  double solve(const QpData& data);

  /// For the last program: whether there is an answer, and x (n).
  bool solved() const;
  Eigen::Map<const Eigen::VectorXd> x() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace mpm
