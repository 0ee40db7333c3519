#include "analysis/findings/monitored_loop.hpp"

#include <cmath>

namespace mpm {

MonitoredLoop monitored_loop(const Study& study, const ExperimentRecord& record,
                             const AssessmentRecord& assessment) {
  MonitoredLoop found;
  const bool faulty = !is_faultless(record.draw.kind);
  const int onset = record.draw.onset.sample;
  const Eigen::MatrixXd flags = assessment.values("window_flagged");
  bool was_flagged = false;
  for (Eigen::Index window = 0; window < flags.cols(); ++window) {
    const double flag = flags(0, window);
    if (std::isnan(flag))
      continue;
    const bool flagged = flag == 1.0;
    const int end = study.monitoring->end(static_cast<int>(window));
    if (!faulty || end <= onset) {
      ++found.verdicts_before;
      found.false_alarms += flagged && !was_flagged ? 1 : 0;
    } else if (!std::isfinite(found.delay)) {
      found.delay = flagged ? (end - onset) * study.controller.sample_time : kInfinity;
    }
    was_flagged = flagged;
  }
  return found;
}

std::optional<double> days_in(std::string_view time_unit) {
  if (time_unit == "s")
    return 1.0 / 86400.0;
  if (time_unit == "min")
    return 1.0 / 1440.0;
  if (time_unit == "h")
    return 1.0 / 24.0;
  if (time_unit == "d")
    return 1.0;
  return std::nullopt;
}

}  // namespace mpm
