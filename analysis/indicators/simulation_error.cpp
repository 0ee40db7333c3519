#include "analysis/indicators/simulation_error.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

Eigen::VectorXd simulation_errors(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                  const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  if (y.rows() != y_sim.rows() || y.cols() != y_sim.cols())
    throw InputError("y_sim", fmt::format("{} x {}", y_sim.rows(), y_sim.cols()),
                     fmt::format("{} x {}, as y", y.rows(), y.cols()));
  return (y_sim - y).rowwise().norm();
}

}  // namespace mpm
