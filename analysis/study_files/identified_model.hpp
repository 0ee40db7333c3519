#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/step_test.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "scenarios/study/study.hpp"

// A model for the controller, identified from steps of a study's plant.

namespace mpm {

/// A channel as a step test gives it.
struct IdentifiedChannel {
  std::string cv, input;  ///< names
  StepResponseFit fit;
  double asymmetry;   ///< StepResponse::asymmetry of the CV
  double rms_error;   ///< under the step, in the unit of the CV
  std::string doubt;  ///< the reason against it, a sentence; empty: none
};

/// What a step test of the plant of a study gives.
struct IdentifiedModel {
  StepTestOptions test;
  std::vector<StepResponse> responses;      ///< of each MV and then each MD
  std::vector<IdentifiedChannel> channels;  ///< those that are not zero, CV by CV

  /// A sentence for each channel that is in doubt, each CV that nothing moves, and each input that moves
  /// nothing.
  std::vector<std::string> warnings(const Study& study) const;
};

/// The steps that a study suggests for its inputs (MVs and then MDs): 2 % of the range of an MV between its
/// hard limits, the largest step of an MD in the study; NaN where there is none.
Eigen::VectorXd usual_steps(const Study& study);

/// Steps the plant and fits each response. Errors: as step_test(), and InputError("--step") where no step
/// moves a CV.
IdentifiedModel identified_model(const Study& study, const StepTestOptions& test);

/// The model as the table [plant] of a study file, with comments on the fit of each channel.
std::string model_toml(const Study& study, const IdentifiedModel& model);

/// The responses themselves as CSV, a column CV/INPUT for each channel, which `init --step-response` reads.
std::string step_response_csv(const Study& study, const IdentifiedModel& model);

}  // namespace mpm
