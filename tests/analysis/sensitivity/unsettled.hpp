#pragma once

#include <algorithm>

#include "analysis/sensitivity/nominal_sensitivity.hpp"

namespace mpm::testing {

/// Largest change over the last tenth of the step responses: small when they have settled.
inline double unsettled(const NominalSensitivity& t0) {
  double largest = 0.0;
  for (const Eigen::MatrixXd& response : t0.step_response) {
    const Eigen::Index tail = std::max<Eigen::Index>(1, response.cols() / 10);
    const Eigen::MatrixXd change = response.rightCols(tail).colwise() - response.rightCols<1>().col(0);
    largest = std::max(largest, change.cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace mpm::testing
