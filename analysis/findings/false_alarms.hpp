#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/findings/endings.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// How often a method flags loops in which model and plant agree: the healthy experiments of a study, those
/// with a bad tuning, or those of them in which one parameter was changed.
struct FalseAlarms : Endings {
  ExperimentKind kind = ExperimentKind::healthy;
  std::optional<TuningParameter> parameter;  ///< none: all experiments of the kind
  Rate false_alarm;                          ///< of those with a verdict: flagged
  Rate false_mpm;  ///< of those with a verdict: flagged, and the source is called a mismatch
  Rate false_ud;   ///< of those with a verdict: flagged, and the source is called a disturbance

  /// "healthy", "tuning", "tuning_move_suppression", ...
  std::string name() const;
  /// The same for people: "healthy", "tuning", "move suppression".
  std::string label() const;
  /// Is this experiment one of the group?
  bool has(const ExperimentDraw& draw) const;
};

/// The kinds without a fault that the study has, and after `tuning` each parameter that it may draw. `method`
/// is the place of the method in the assessments of each record.
Collector<std::vector<FalseAlarms>> false_alarm_collector(const Study& study, std::size_t method);

/// Its rows: all shares of a kind, of one parameter that was changed the false alarms only.
std::vector<Finding> rows_of(const FalseAlarms& group, const std::string& method);

}  // namespace mpm
