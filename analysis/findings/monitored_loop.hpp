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
  std::int64_t verdicts_before = 0;  ///< fault-free windows with a verdict
  std::int64_t false_alarms = 0;     ///< alarms that begin in fault-free windows
  /// Time from the onset to the end of the first flagged window that ends after it, in the time unit of the
  /// plant; infinite if none is flagged, NaN without a fault, or if none of these windows has a verdict.
  double delay = kNaN;
};

/// Evaluates the windows of a loop on which the method has a verdict. The study must monitor.
MonitoredLoop monitored_loop(const Study& study, const ExperimentRecord& record,
                             const AssessmentRecord& assessment);

/// The length of a time unit in days, for "s", "min", "h" and "d"; none for other units.
std::optional<double> days_in(std::string_view time_unit);

}  // namespace mpm
