#include "analysis/experiment/scenario_verdict.hpp"

#include <algorithm>
#include <limits>

namespace mpm {
namespace {

ExperimentKind source_of(const std::vector<AffectedCv>& affected, Eigen::Index cv) {
  const auto place =
      std::find_if(affected.begin(), affected.end(), [cv](const auto& a) { return a.cv == cv; });
  return place == affected.end() ? ExperimentKind::none : place->by;
}

}  // namespace

ScenarioVerdict scenario_verdict(const ExperimentRecord& record) {
  ScenarioVerdict verdict;
  const std::vector<AffectedCv> affected = record.draw.affected();
  for (std::size_t i = 0; i < record.diagnosis.cvs.size(); ++i) {
    const CvDiagnosis& found = record.diagnosis.cvs[i];
    const auto cv = static_cast<Eigen::Index>(i);
    const ExperimentKind truth = source_of(affected, cv);
    if (truth == ExperimentKind::none) {
      if (found.flagged)
        verdict.false_alarms.push_back(cv);
      continue;
    }
    (found.flagged ? verdict.found : verdict.missed).push_back(cv);
    if (!found.flagged || truth == ExperimentKind::mpm_ud)
      continue;
    verdict.judged_source = true;
    if (found.source != truth)
      verdict.wrong_source.push_back(cv);
  }
  return verdict;
}

double total_simulation_error(const Diagnosis& diagnosis) {
  if (diagnosis.cvs.empty())
    return std::numeric_limits<double>::quiet_NaN();
  double total = 0.0;
  for (const CvDiagnosis& cv : diagnosis.cvs)
    total += cv.sse;
  return total;
}

}  // namespace mpm
