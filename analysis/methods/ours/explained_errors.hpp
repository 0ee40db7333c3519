#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// What a fault around the model adds to the CVs if it has the parameters that explain their simulation
/// errors best: for each CV N numbers in standard deviations of its noise, or none if the fault does not move
/// the CV. The evidence of the fault is the likelihood of what it leaves, less `penalty` = k/2 log n for its
/// k free parameters (Schwarz 1978).
struct ExplainedErrors {
  std::vector<Eigen::RowVectorXd> of_cvs;
  double penalty = 0.0;

  bool is_any() const { return !of_cvs.empty(); }
};

}  // namespace mpm
