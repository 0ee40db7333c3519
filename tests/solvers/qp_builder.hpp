#pragma once

#include <memory>
#include <utility>

#include "tests/solvers/qp_collection.hpp"

namespace mpm::samples {

/// Builds a NamedQp by naming only what differs from "no limits": every call returns the builder.
class QpBuilder {
 public:
  /// 1/2 x'Hx + g'x without rows.
  QpBuilder(std::string name, Eigen::MatrixXd hessian, const Eigen::VectorXd& gradient);

  QpBuilder& box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  /// Adds a slack with the cost quadratic s^2 + linear s.
  QpBuilder& slack(double quadratic, double linear);
  /// Adds a row with hard limits.
  QpBuilder& hard(const Eigen::VectorXd& row, double lower, double upper);
  /// Adds a row with soft limits relaxed by slack `q`.
  QpBuilder& soft(const Eigen::VectorXd& row, int q, double lower, double upper);
  /// Sets the hard limits of the row added last.
  QpBuilder& also_hard(double lower, double upper);
  QpBuilder& answer(const Eigen::VectorXd& x);
  QpBuilder& not_unique();
  QpBuilder& infeasible();

  operator NamedQp() const { return build(); }
  NamedQp build() const;

 private:
  void add_row(const Eigen::VectorXd& row, int q);

  NamedQp qp_;
  QpStructure structure_;
};

/// (a, b, ...) as a vector.
template <typename... Numbers>
Eigen::VectorXd vec(Numbers... numbers) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(sizeof...(numbers)));
  Eigen::Index i = 0;
  ((result(i++) = static_cast<double>(numbers)), ...);
  return result;
}

}  // namespace mpm::samples
