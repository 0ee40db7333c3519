#include "analysis/methods/literature/subspace_angle.hpp"

#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/statistics/interval.hpp"
#include "base/error.hpp"

namespace mpm {

Eigen::VectorXd subspace_cosines(const Eigen::Ref<const Eigen::MatrixXd>& directions) {
  const Eigen::Index ny = directions.rows();
  const Eigen::Index m = directions.cols();
  if (m > ny)
    throw InputError("directions of a subspace", fmt::format("{}", m),
                     fmt::format("{} or fewer, the number of CVs", ny));
  if (!directions.allFinite())
    throw InputError("directions of a subspace", "a value that is not finite", "finite values only");
  if (m == 0)
    return Eigen::VectorXd::Zero(ny);
  // P (P^T P)^-1 P^T = Q Q^T, without squaring the condition of P; |Q Q^T ev_k| is the norm of row k of Q.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(directions);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(ny, m);
  return basis.rowwise().norm();
}

double subspace_cosine_limit(Eigen::Index samples_benchmark, Eigen::Index samples_monitored,
                             double confidence) {
  if (samples_benchmark < 1 || samples_monitored < 1)
    throw InputError("samples of two records", fmt::format("{} and {}", samples_benchmark, samples_monitored),
                     "1 or more each");
  const double geometric_mean =
      std::sqrt(static_cast<double>(samples_benchmark) * static_cast<double>(samples_monitored));
  return std::sqrt(0.5 + two_sided_normal_quantile(confidence) / std::sqrt(2.0 * geometric_mean));
}

}  // namespace mpm
