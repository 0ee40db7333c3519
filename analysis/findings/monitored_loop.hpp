#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "analysis/experiment/experiment_record.hpp"
#include "base/non_finite.hpp"

// The results of a method that watches a loop through a moving window.

namespace mpm {

/// The verdicts of one method on the windows of one loop. A window that ends before the onset of the fault,
/// and any window of a loop without a fault, is fault-free. An alarm begins where a flagged window follows
/// one that is not flagged, so an alarm that lasts over several windows counts once.
struct MonitoredLoop {
  std::int64_t verdicts_before = 0;  ///< windows with a verdict and nothing to find
  std::int64_t false_alarms = 0;     ///< alarms that begin in them
  /// Time from the onset to the end of the first flagged window that ends after it, in the time unit of the
  /// plant; infinite when there is none, NaN without a fault, or without a verdict on any of these windows.
  double delay = kNaN;
};

/// The windows of a loop on which the method has a verdict, in a study that monitors.
MonitoredLoop monitored_loop(const Study& study, const ExperimentRecord& record,
                             const AssessmentRecord& assessment);

/// Days in a time unit: "s", "min", "h" or "d"; none for other units.
std::optional<double> days_in(std::string_view time_unit);

}  // namespace mpm
