#include "analysis/records/assessed_record.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

bool RecordAssessment::is_flagged(std::size_t method) const {
  const AssessmentRecord& of = said[method];
  if (trial && !trial->methods[method])
    return of.answered() && of.flagged && model.score > model_threshold();
  const TrialFindings* const found = trial_of(method);
  return of.answered() &&
         (found == nullptr || std::isnan(found->threshold) ? of.flagged : of.score > found->threshold);
}

Eigen::Index worst_cv(const RecordAssessment& of) {
  const Eigen::Index named = of.verdict.named_cv();
  return named >= 0 ? named : std::max<Eigen::Index>(0, of.model.predicted_cv);
}

const RepairProspect* RecordAssessment::named_prospect() const {
  return repair ? prospect_of(prospects, repair->repair.channel) : nullptr;
}

}  // namespace mpm
