#include "analysis/identification/nested_least_squares.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_problem(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                     double rank_tolerance) {
  if (A.rows() <= A.cols())
    throw InputError("samples of nested least-squares problems",
                     fmt::format("{} for {} parameters", A.rows(), A.cols()), "more samples than parameters");
  if (B.rows() != A.rows())
    throw InputError("right-hand sides of nested least-squares problems", fmt::format("{} samples", B.rows()),
                     fmt::format("{}", A.rows()));
  if (!(rank_tolerance > 0.0 && rank_tolerance < 1.0))
    throw InputError("rank tolerance", fmt::format("{}", rank_tolerance), "above 0 and below 1");
}

Eigen::MatrixXd unit_columns(const Eigen::Ref<const Eigen::MatrixXd>& A,
                             const std::vector<Eigen::Index>& kept, const Eigen::VectorXd& norms) {
  Eigen::MatrixXd unit(A.rows(), norms.size());
  for (Eigen::Index j = 0; j < norms.size(); ++j)
    unit.col(j) = A.col(kept[static_cast<std::size_t>(j)]) / norms(j);
  return unit;
}

}  // namespace

NestedLeastSquares::NestedLeastSquares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                       const Eigen::Ref<const Eigen::MatrixXd>& B, double rank_tolerance) {
  require_problem(A, B, rank_tolerance);
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    if ((A.col(j).array() != 0.0).any())
      kept_.push_back(j);
  // Factorises again without the dependent columns, because each of them takes up a row of Q'B.
  for (bool independent = false; !independent;) {
    norms_.resize(static_cast<Eigen::Index>(kept_.size()));
    for (Eigen::Index j = 0; j < norms_.size(); ++j)
      norms_(j) = A.col(kept_[static_cast<std::size_t>(j)]).norm();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(unit_columns(A, kept_, norms_));
    std::vector<Eigen::Index> remaining;
    for (Eigen::Index j = 0; j < norms_.size(); ++j)
      if (std::abs(qr.matrixQR()(j, j)) > rank_tolerance)
        remaining.push_back(kept_[static_cast<std::size_t>(j)]);
    independent = remaining.size() == kept_.size();
    kept_ = remaining;
    if (independent) {
      R_ = qr.matrixQR().topRows(norms_.size()).triangularView<Eigen::Upper>();
      rotated_ = qr.householderQ().adjoint() * B;
    }
  }
}

Eigen::Index NestedLeastSquares::rank(Eigen::Index columns) const {
  return std::lower_bound(kept_.begin(), kept_.end(), columns) - kept_.begin();
}

double NestedLeastSquares::residual_sum(Eigen::Index columns, Eigen::Index side) const {
  return rotated_.col(side).tail(rotated_.rows() - rank(columns)).squaredNorm();
}

Eigen::VectorXd NestedLeastSquares::solution(Eigen::Index columns, Eigen::Index side) const {
  const Eigen::Index r = rank(columns);
  const Eigen::VectorXd scaled =
      R_.topLeftCorner(r, r).triangularView<Eigen::Upper>().solve(rotated_.col(side).head(r));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(columns);
  for (Eigen::Index j = 0; j < r; ++j)
    x(kept_[static_cast<std::size_t>(j)]) = scaled(j) / norms_(j);
  return x;
}

}  // namespace mpm
