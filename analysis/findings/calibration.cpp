#include "analysis/findings/calibration.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/statistics/conformal_threshold.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

CalibratedThreshold threshold_of(const std::vector<double>& scores, double false_alarms) {
  return {conformal_threshold(scores, false_alarms), std::ssize(scores)};
}

}  // namespace

double calibration_score(const AssessmentRecord& said) {
  if (!said.answered())
    return kNaN;
  return std::isnan(said.score) ? -kInfinity : said.score;
}

Calibration calibration_of(const Study& loops, const RecordRange& records) {
  Calibration calibration{loops.seed, {}};
  records.each([&](const ExperimentRecord& record) {
    CalibrationLoop loop{record.draw.kind, {}};
    for (const AssessmentRecord& said : record.assessments)
      loop.scores.push_back(calibration_score(said));
    calibration.loops.push_back(std::move(loop));
  });
  return calibration;
}

CalibratedThresholds calibrated_thresholds(const Study& study, const Calibration& calibration,
                                           std::size_t method) {
  std::vector<double> healthy, not_mpm;
  for (const CalibrationLoop& loop : calibration.loops) {
    const double score = loop.scores[method];
    if (std::isnan(score))
      continue;
    not_mpm.push_back(score);
    if (loop.kind == ExperimentKind::healthy)
      healthy.push_back(score);
  }
  return {threshold_of(healthy, 0.01), threshold_of(healthy, 0.05),
          threshold_of(healthy, study.calibration->false_alarms), threshold_of(not_mpm, 0.05)};
}

}  // namespace mpm
