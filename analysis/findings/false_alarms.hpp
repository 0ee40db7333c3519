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

/// How often a method flags loops in which model and plant agree: the healthy experiments of a study, the
/// experiments with a bad tuning, or the experiments in which one given tuning parameter was changed.
struct FalseAlarms : Endings {
  ExperimentKind kind = ExperimentKind::healthy;
  std::optional<TuningParameter> parameter;  ///< none: all experiments of the kind
  Rate false_alarm;                          ///< flagged, of the experiments with a verdict
  Rate false_mpm;  ///< flagged with a mismatch as the source, of the experiments with a verdict
  Rate false_ud;   ///< flagged with a disturbance as the source, of the experiments with a verdict

  /// "healthy", "tuning", "tuning_move_suppression", ...
  std::string name() const;
  /// The same for people: "healthy", "tuning", "move suppression".
  std::string label() const;
  /// Whether the experiment belongs to the group.
  bool has(const ExperimentDraw& draw) const;
};

/// Collects one group for each kind without a fault that the study has and, after `tuning`, one for each
/// parameter that the study may change. `method` is the place of the method in the assessments of each
/// record.
Collector<std::vector<FalseAlarms>> false_alarm_collector(const Study& study, std::size_t method);

/// Returns the rows of a group: all shares for a kind, but only the share of false alarms for a single
/// parameter.
std::vector<Finding> rows_of(const FalseAlarms& group, const std::string& method);

}  // namespace mpm
