#include "analysis/sensitivity/relative_gain.hpp"

#include <complex>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

void require_square(const char* name, const Eigen::Ref<const Eigen::MatrixXcd>& matrix) {
  if (matrix.rows() != matrix.cols() || matrix.rows() == 0)
    throw InputError(name, fmt::format("{} x {}", matrix.rows(), matrix.cols()), "a square matrix");
  if (!matrix.allFinite())
    throw InputError(name, "a value that is not finite", "finite values only");
}

}  // namespace

Eigen::MatrixXcd relative_gains(const Eigen::Ref<const Eigen::MatrixXcd>& G) {
  require_square("G of relative gains", G);
  // The rank is found from pivots, which needs rows and columns of similar size; otherwise the units would
  // decide it. Relative gains do not depend on this scaling.
  const Eigen::VectorXd row = G.cwiseAbs().rowwise().maxCoeff();
  const Eigen::MatrixXcd by_row = row.cwiseInverse().asDiagonal() * G;
  const Eigen::VectorXd col = by_row.cwiseAbs().colwise().maxCoeff().transpose();
  const Eigen::MatrixXcd scaled = by_row * col.cwiseInverse().asDiagonal();
  const bool has_zeros = row.minCoeff() == 0.0 || col.minCoeff() == 0.0;
  const Eigen::FullPivLU<Eigen::MatrixXcd> lu(scaled);
  if (has_zeros || !lu.isInvertible())
    return Eigen::MatrixXcd::Constant(G.rows(), G.cols(), kNaN);
  return scaled.cwiseProduct(lu.inverse().transpose());
}

double rpn_weight(const Eigen::Ref<const Eigen::MatrixXcd>& T0) {
  require_square("T0 of an RPN weight", T0);
  const Eigen::MatrixXcd S0 = Eigen::MatrixXcd::Identity(T0.rows(), T0.cols()) - T0;
  const Eigen::MatrixXcd product = S0 * T0;
  if (!product.allFinite())
    return kNaN;
  return Eigen::JacobiSVD<Eigen::MatrixXcd, Eigen::NoQRPreconditioner>(product).singularValues()(0);
}

}  // namespace mpm
