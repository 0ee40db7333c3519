#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenarios/study/study.hpp"

namespace mpm {

/// How the step test of a plant is run.
struct StepTestOptions {
  Eigen::VectorXd sizes;  ///< of the step of each MV and then each MD, > 0
  int samples = 0;        ///< of each response, > 0
  bool noise = false;     ///< with the measurement noise of the study
};

/// The effect of a step of one input on the CVs.
///
/// | name      | shape       | meaning                                                               |
/// |-----------|-------------|-----------------------------------------------------------------------|
/// | response  | ny x samples | (y_up - y_down)/(2 size), 1, 2, ... samples after the step           |
/// | asymmetry | ny          | rms of y_up + y_down over that of y_up - y_down: 0 for a linear plant |
struct StepResponse {
  Eigen::MatrixXd response;
  Eigen::VectorXd asymmetry;
};

/// Steps every input of the plant of the study up and, again from rest, down: in open loop, about the
/// operating point, without faults. In the mean of the two responses, an effect of nonlinearity that is the
/// same for both cancels. The noise has a random stream of its own. Throws InputError for sizes that do not
/// fit, a number of samples < 1, a plant that fails under a step, and as Plant::reset().
std::vector<StepResponse> step_test(const Study& study, const StepTestOptions& options);

}  // namespace mpm
