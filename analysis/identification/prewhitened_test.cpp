#include "analysis/identification/prewhitened_test.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/statistics/f_distribution.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// A pivoted factorisation with the tolerance of the regressors.
Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factorised(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
  qr.setThreshold(kRegressorTolerance);
  qr.compute(A);
  return qr;
}

/// The columns about their means, scaled to unit norm; zero for a column that does not move.
Eigen::MatrixXd unit_regressors(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd unit = x.rowwise() - x.colwise().mean();
  for (Eigen::Index j = 0; j < unit.cols(); ++j) {
    const double norm = unit.col(j).norm();
    if (norm > kRegressorTolerance * x.col(j).norm())
      unit.col(j) /= norm;
    else
      unit.col(j).setZero();
  }
  return unit;
}

/// All groups side by side, N x sum of m_g.
Eigen::MatrixXd side_by_side(const std::vector<Eigen::MatrixXd>& groups, Eigen::Index samples) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& group : groups) {
    if (group.rows() != samples)
      throw InputError("samples of a group of regressors", fmt::format("{}", group.rows()),
                       fmt::format("{}", samples));
    columns += group.cols();
  }
  Eigen::MatrixXd x(samples, columns);
  Eigen::Index next = 0;
  for (const Eigen::MatrixXd& group : groups) {
    x.middleCols(next, group.cols()) = group;
    next += group.cols();
  }
  if (!x.allFinite())
    throw InputError("regressors", "a value that is not finite", "finite values only");
  return x;
}

/// Tests the group at columns first ... first + count - 1 of R. R has the regressors in an orthonormal basis
/// (r x m), in which the target is c (r). The group explains the part of c outside the span of the other
/// columns.
FTest partial_test(const Eigen::MatrixXd& R, const Eigen::VectorXd& c, Eigen::Index first, Eigen::Index count,
                   double variance, Eigen::Index freedom) {
  Eigen::MatrixXd others(R.rows(), R.cols() - count);
  others << R.leftCols(first), R.rightCols(R.cols() - first - count);
  FTest test;
  double explained = c.squaredNorm();
  Eigen::Index rank = 0;
  if (others.cols() > 0) {
    const auto qr = factorised(others);
    rank = qr.rank();
    const Eigen::VectorXd rotated = qr.householderQ().adjoint() * c;
    explained = rotated.tail(c.size() - rank).squaredNorm();
  }
  test.freedom = c.size() - rank;
  if (test.freedom == 0)
    return test;
  test.f = explained / static_cast<double>(test.freedom) / variance;
  test.log_p = log_f_tail(test.f, static_cast<double>(test.freedom), static_cast<double>(freedom));
  return test;
}

}  // namespace

PrewhitenedTest prewhitened_test(const Eigen::Ref<const Eigen::VectorXd>& e,
                                 const std::vector<Eigen::MatrixXd>& groups,
                                 const Autoregression& whiteness) {
  const Eigen::MatrixXd x = unit_regressors(whiteness.whitened(side_by_side(groups, e.size())));
  Eigen::VectorXd w = whiteness.whitened(e);
  w.array() -= w.mean();
  PrewhitenedTest result;
  result.order = whiteness.order();
  result.groups.resize(groups.size());
  const Eigen::Index needed = x.cols() + kLeastFreedom;
  if (whiteness.freedom() < needed)
    throw InputError("samples of a prewhitened test", fmt::format("{} without a gap", w.size()),
                     fmt::format("{} or more", needed + whiteness.order() + 1));
  if (x.cols() == 0)
    return result;
  const auto qr = factorised(x);
  const Eigen::Index r = qr.rank();
  const Eigen::VectorXd rotated = qr.householderQ().adjoint() * w;
  const Eigen::Index freedom = whiteness.freedom() - r;
  // A residual that is only rounding must not be the variance to divide by.
  const double residual = std::max(rotated.tail(rotated.size() - r).squaredNorm(),
                                   std::numeric_limits<double>::epsilon() * w.squaredNorm());
  if (r == 0 || !(residual > 0.0))
    return result;
  const double variance = residual / static_cast<double>(freedom);
  Eigen::MatrixXd R = qr.matrixR().topRows(r).triangularView<Eigen::Upper>();
  R = R * qr.colsPermutation().inverse();
  const Eigen::VectorXd c = rotated.head(r);
  result.all = partial_test(R, c, 0, R.cols(), variance, freedom);
  Eigen::Index first = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    result.groups[g] = partial_test(R, c, first, groups[g].cols(), variance, freedom);
    first += groups[g].cols();
  }
  return result;
}

}  // namespace mpm
