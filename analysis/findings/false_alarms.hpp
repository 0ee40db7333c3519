#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// How often the chain sees a modelling error where there is none: in the healthy experiments of a study, in
/// those with a bad tuning, or in those of them in which one parameter was changed.
struct FalseAlarms {
  ExperimentKind kind = ExperimentKind::none;
  std::optional<TuningParameter> parameter;  ///< none: all experiments of the kind
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  Rate infeasible;   ///< of the experiments that did not fail
  Rate false_alarm;  ///< of the feasible ones: some Ivar lies outside the band of impact
  Rate false_mpm;    ///< of the feasible ones: the alarm says model-plant mismatch
  Rate false_ud;     ///< of the feasible ones: the alarm says unmeasured disturbance

  /// "healthy", "tuning", "tuning_move_suppression", ...
  std::string name() const;
};

/// The key of [experiments] that counts this kind: "healthy" for none, and the name of the kind otherwise.
std::string_view count_name(ExperimentKind kind);

/// The kinds without a fault that the study has, and after `tuning` each parameter that it may draw.
std::vector<FalseAlarms> false_alarms(const Study& study, std::span<const ExperimentRecord> records);

}  // namespace mpm
