#pragma once

#include <vector>

#include "analysis/experiment/experiment.hpp"

namespace mpm {

/// What the chain says of a named scenario, CV by CV, against what the study says of it.
struct ScenarioVerdict {
  std::vector<Eigen::Index> found;         ///< affected CVs whose Ivar_diag lies outside the band of impact
  std::vector<Eigen::Index> missed;        ///< affected CVs whose Ivar_diag lies inside
  std::vector<Eigen::Index> false_alarms;  ///< other CVs whose Ivar_diag lies outside
  /// Found CVs with one sort of fault that I_MPM takes for the other. With both sorts on a CV, either is
  /// right.
  std::vector<Eigen::Index> wrong_source;
  bool judged_source = false;  ///< some found CV has one sort of fault

  bool located() const { return missed.empty() && false_alarms.empty(); }
  bool right() const { return located() && wrong_source.empty(); }
};

/// The verdict on a named scenario whose status is ok; all lists are empty for any other record.
ScenarioVerdict scenario_verdict(const ExperimentRecord& record);

/// TSSE (6.21) of a named scenario; NaN without a diagnosis of every CV.
double total_simulation_error(const Diagnosis& diagnosis);

}  // namespace mpm
