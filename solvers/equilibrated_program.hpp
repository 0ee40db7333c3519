#pragma once

#include <memory>

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// A QP whose variables and rows are scaled so that its numbers are of similar size:
///
///     x = D x',   D_j = 1/sqrt(H_jj),  or 1/max_i |a_ij| where H_jj = 0
///     a_i' = r_i a_i D,   r_i = 1/|a_i D|,  the same for all rows of one slack: s' = r_i s
///     H' = D H D,   g' = D g,   w' = w/r^2,   l' = l/r,   limits of x and of rows divided by D, times r
///
/// (diagonal, or Jacobi, scaling: van der Sluis, Numer. Math. 14 (1969) 14-23: among diagonal scalings it
/// brings the condition of H to within a factor n of the least). D and r are powers of two, so that neither
/// scaling nor scaling back rounds anything.
class EquilibratedProgram {
 public:
  explicit EquilibratedProgram(const QpStructure& structure);

  const std::shared_ptr<const QpStructure>& structure() const { return structure_; }

  /// Returns `data` in the scaled units; valid until the next call. Allocates nothing.
  const QpData& scaled(const QpData& data);

  /// Scales an answer back to the original units: status, x, slack and multipliers.
  void write_back(const QpResult& scaled, QpResult& result) const;

  /// Scales y, a proof that the hard limits cannot all be kept, back to the original units.
  void write_certificate(const Eigen::VectorXd& scaled, Eigen::VectorXd& certificate) const;

 private:
  std::shared_ptr<const QpStructure> structure_;
  Eigen::VectorXd variable_;  ///< D, n
  Eigen::VectorXd row_;       ///< r, m
  Eigen::VectorXd slack_;     ///< r of each slack, q
  QpData data_;
};

}  // namespace mpm
