#pragma once

#include <string_view>
#include <vector>

#include "analysis/basis/s0_structure.hpp"
#include "analysis/findings/study_aggregate.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// Is the number of this name a share of experiments, which people read as a percentage?
bool is_share(std::string_view name);

/// A number of the aggregate beside the one that the study names as reported; NaN when it names none.
struct SummaryValue {
  AggregateValue measured;
  double reported;

  bool has_reported() const;
  bool is_share() const { return mpm::is_share(measured.name); }
};

/// What both forms of the summary are made of. Points into the campaign.
struct SummaryParts {
  StudyAggregate aggregate;
  std::vector<SummaryValue> values;
  AuditSummary audit;
  std::int64_t fallbacks = 0;        ///< problems that Ipopt answered in place of the active-set method
  std::vector<S0Curve> s0_curves;    ///< this and the next two: none unless the study perturbs S0
  std::vector<DiagonalFit> s0_fits;  ///< of the CVs at a soft limit
  std::vector<StructureFit> structure_fits;  ///< none unless the study fixes MVs
  std::vector<const ExperimentRecord*> failed;
  std::vector<const ExperimentRecord*> wrong;  ///< verdicts, ExperimentRecord::wrong()
};

SummaryParts summary_parts(const Campaign& campaign);

}  // namespace mpm
