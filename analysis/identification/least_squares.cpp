#include "analysis/identification/least_squares.hpp"

#include <Eigen/QR>
#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_problem(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& b,
                     double rank_tolerance) {
  if (A.cols() == 0 || A.rows() < A.cols())
    throw InputError("samples of a least-squares problem",
                     fmt::format("{} for {} parameters", A.rows(), A.cols()),
                     "at least as many samples as parameters, and one parameter");
  if (b.size() != A.rows())
    throw InputError("right-hand side of a least-squares problem", fmt::format("{} samples", b.size()),
                     fmt::format("{}", A.rows()));
  if (!(rank_tolerance > 0.0 && rank_tolerance < 1.0))
    throw InputError("rank tolerance", fmt::format("{}", rank_tolerance), "above 0 and below 1");
}

/// 1/norm of each column, 1 for a column of zeros.
Eigen::VectorXd column_scales(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  const Eigen::VectorXd norms = A.colwise().norm().transpose();
  return (norms.array() > 0.0).select(norms.cwiseInverse(), 1.0);
}

}  // namespace

LeastSquares least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                           const Eigen::Ref<const Eigen::VectorXd>& b, double rank_tolerance) {
  require_problem(A, b, rank_tolerance);
  const Eigen::Index p = A.cols();
  const Eigen::VectorXd scale = column_scales(A);
  Eigen::MatrixXd augmented(A.rows(), p + 1);
  augmented.leftCols(p) = A * scale.asDiagonal();
  augmented.col(p) = b;
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(augmented);
  const Eigen::MatrixXd R = qr.matrixQR().topLeftCorner(p, p).triangularView<Eigen::Upper>();
  const Eigen::VectorXd rotated = qr.matrixQR().col(p).head(p);

  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> pivoted(p, p);
  pivoted.setThreshold(rank_tolerance);
  pivoted.compute(R);
  LeastSquares result;
  result.rank = pivoted.rank();
  if (result.rank < p) {
    result.x = scale.asDiagonal() * pivoted.solve(rotated);
  } else {
    const Eigen::MatrixXd inverse_of_R =
        R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(p, p));
    const Eigen::MatrixXd factor = scale.asDiagonal() * inverse_of_R;
    result.x = scale.asDiagonal() * R.triangularView<Eigen::Upper>().solve(rotated);
    result.inverse = factor * factor.transpose();
  }
  result.residual_sum = (A * result.x - b).squaredNorm();
  return result;
}

}  // namespace mpm
