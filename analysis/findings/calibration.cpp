#include "analysis/findings/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/statistics/conformal_threshold.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/world.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

CalibratedThreshold threshold_of(const std::vector<double>& scores, double false_alarms) {
  return {conformal_threshold(scores, false_alarms), std::ssize(scores)};
}

/// CalibratedThresholds::redrawn_05 from the healthy scores of each world.
std::vector<double> redrawn_thresholds(const std::vector<std::vector<double>>& worlds, std::uint64_t seed) {
  std::vector<double> redrawn;
  for (int draw = 0; draw < kRedraws; ++draw) {
    RandomStream stream(seed, static_cast<std::uint64_t>(draw), StreamId::bootstrap);
    std::vector<double> scores;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      const std::vector<double>& world = worlds[static_cast<std::size_t>(stream.below(worlds.size()))];
      scores.insert(scores.end(), world.begin(), world.end());
    }
    redrawn.push_back(conformal_threshold(scores, 0.05).value_or(kInfinity));
  }
  std::sort(redrawn.begin(), redrawn.end());
  return redrawn;
}

}  // namespace

int CalibratedThresholds::redraws_exceeded_by(double score) const {
  return std::isnan(score) ? 0
                           : static_cast<int>(std::lower_bound(redrawn_05.begin(), redrawn_05.end(), score) -
                                              redrawn_05.begin());
}

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
  const Study loops = calibration_study(study);
  std::vector<double> healthy, not_mpm;
  std::vector<std::vector<double>> worlds(static_cast<std::size_t>(loops.world ? loops.world->count : 0));
  for (std::size_t i = 0; i < calibration.loops.size(); ++i) {
    const CalibrationLoop& loop = calibration.loops[i];
    const double score = loop.scores[method];
    if (std::isnan(score))
      continue;
    not_mpm.push_back(score);
    if (loop.kind != ExperimentKind::healthy)
      continue;
    healthy.push_back(score);
    if (loops.world)
      worlds[static_cast<std::size_t>(world_of(loops, static_cast<std::int64_t>(i)))].push_back(score);
  }
  CalibratedThresholds found{threshold_of(healthy, 0.01), threshold_of(healthy, 0.05),
                             threshold_of(healthy, study.calibration->false_alarms),
                             threshold_of(not_mpm, 0.05)};
  std::erase_if(worlds, [](const std::vector<double>& scores) { return scores.empty(); });
  if (found.at_05.value && !worlds.empty())
    found.redrawn_05 = redrawn_thresholds(worlds, loops.seed);
  return found;
}

}  // namespace mpm
