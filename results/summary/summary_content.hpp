#pragma once

#include <string_view>
#include <vector>

#include "analysis/basis/s0_perturbation_structure.hpp"
#include "analysis/findings/study_findings.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// How many experiments of a kind there are.
struct KindCount {
  ExperimentKind kind;
  std::int64_t experiments;
};

/// Of each kind that a study of random experiments has; none of named scenarios.
std::vector<KindCount> kind_counts(const Campaign& campaign);

/// "150 MPM, 150 UD, 100 MPM+UD"; "named scenarios".
std::string kinds_text(const Campaign& campaign);

/// What both forms of the summary are made of. Points into the campaign.
struct SummaryContent {
  explicit SummaryContent(const StudyFindings& of_campaign) : findings(of_campaign) {}

  const StudyFindings& findings;
  AuditSummary audit;
  std::int64_t fallbacks = 0;        ///< problems that Ipopt answered in place of the active-set method
  std::vector<S0Curve> s0_curves;    ///< this and the next two: none unless the study perturbs S0
  std::vector<DiagonalFit> s0_fits;  ///< of the CVs at a soft limit
  std::vector<StructureFit> structure_fits;  ///< none unless the study fixes MVs
  std::vector<const ExperimentRecord*> failed;
  std::vector<const ExperimentRecord*> wrong;  ///< verdicts of the chain, Judgement::wrong()
};

/// `campaign` and `findings` must outlive the parts.
SummaryContent summary_content(const Campaign& campaign, const StudyFindings& findings);

}  // namespace mpm
