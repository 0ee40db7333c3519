#include "analysis/methods/ours/coloured_noise.hpp"

#include <Eigen/Cholesky>

namespace mpm {

Eigen::VectorXd autoregression_of(const Eigen::VectorXd& r, Eigen::Index order) {
  const Eigen::Index n = r.size() - order;
  Eigen::MatrixXd past(n, order);
  for (Eigen::Index lag = 0; lag < order; ++lag)
    past.col(lag) = r.segment(order - 1 - lag, n);
  Eigen::MatrixXd A = past.transpose() * past;
  A.diagonal().array() += 1e-12 * A.trace() + 1e-300;
  return A.ldlt().solve(past.transpose() * r.tail(n));
}

Eigen::MatrixXd whitened_by(const Eigen::VectorXd& a, const Eigen::MatrixXd& signals) {
  const Eigen::Index p = a.size(), n = signals.rows() - p;
  Eigen::MatrixXd white = signals.bottomRows(n);
  for (Eigen::Index lag = 0; lag < p; ++lag)
    white -= a(lag) * signals.middleRows(p - 1 - lag, n);
  return white;
}

}  // namespace mpm
