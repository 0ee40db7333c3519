#pragma once

#include <memory>

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// HPIPM (github.com/giaf/hpipm, an interior-point method in C on BLASFEO) on the programs of one sequence
/// with one slack a row: its solver for dense programs in the mode SPEED, to 1e-8. It starts each program
/// from nothing. The hard limits of the rows are left out, as for DaqpRival.
class HpipmRival {
 public:
  explicit HpipmRival(const QpStructure& structure);
  ~HpipmRival();
  HpipmRival(const HpipmRival&) = delete;
  HpipmRival& operator=(const HpipmRival&) = delete;

  /// Solves a program. Returns the seconds that HPIPM took, without the time to copy the limits.
  double solve(const QpData& data);

  /// For the last program: whether there is an answer, and x (n).
  bool solved() const;
  const Eigen::VectorXd& x() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace mpm
