#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/step_test.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "scenarios/study/study.hpp"

// A model for the controller, identified from steps of a study's plant.

namespace mpm {

/// A channel identified by a step test.
struct IdentifiedChannel {
  std::string cv, input;  ///< names
  StepResponseFit fit;
  double asymmetry;   ///< StepResponse::asymmetry of the CV
  double rms_error;   ///< under the step, in the unit of the CV
  std::string doubt;  ///< the reason to doubt it, a sentence; empty if there is none
};

/// The result of a step test of the plant of a study.
struct IdentifiedModel {
  StepTestOptions test;
  std::vector<StepResponse> responses;      ///< of each MV and then each MD
  std::vector<IdentifiedChannel> channels;  ///< the channels that are not zero, CV by CV

  /// Returns a sentence for each doubtful channel, each CV that no input moves, and each input that moves no
  /// CV.
  std::vector<std::string> warnings(const Study& study) const;
};

/// Returns the steps that a study suggests for its inputs (MVs and then MDs): for an MV 2 % of the range
/// between its hard limits, for an MD its largest step in the study. NaN if the study suggests none.
Eigen::VectorXd usual_steps(const Study& study);

/// Steps the plant and fits each response. Errors: as step_test(), and InputError("--step") if no step moves
/// a CV.
IdentifiedModel identified_model(const Study& study, const StepTestOptions& test);

/// Returns the model as the table [plant] of a study file, with comments on the fit of each channel.
std::string model_toml(const Study& study, const IdentifiedModel& model);

/// Returns the responses themselves as CSV for `init --step-response`, with a column CV/INPUT for each
/// channel.
std::string step_response_csv(const Study& study, const IdentifiedModel& model);

}  // namespace mpm
