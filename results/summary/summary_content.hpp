#pragma once

#include <cstdint>
#include <deque>
#include <string>
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

/// An experiment without a result, and why.
struct FailedExperiment {
  std::int64_t index;
  std::string message;
};

/// How many experiments the summary for people lists one by one.
inline constexpr std::size_t kMostListed = 10;

/// The content of both forms of the summary. It points into the campaign.
struct SummaryContent {
  explicit SummaryContent(const StudyFindings& of_campaign) : findings(of_campaign) {}

  const StudyFindings& findings;
  AuditSummary audit;
  std::int64_t fallbacks = 0;        ///< problems that Ipopt answered in place of the active-set method
  std::vector<S0Curve> s0_curves;    ///< this and the next two: none unless the study perturbs S0
  std::vector<DiagonalFit> s0_fits;  ///< of the CVs at a soft limit
  std::vector<StructureFit> structure_fits;  ///< none unless the study fixes MVs
  std::vector<KindCount> kinds;              ///< of a study of random experiments, those that it has
  std::vector<FailedExperiment> failures;    ///< all of them, as those of the next one
  std::vector<std::int64_t> wrong_verdicts;  ///< of the chain, Judgement::wrong(): index of the experiment
  /// The records of these; of a campaign that is streamed those of the first ones.
  std::vector<const ExperimentRecord*> failed;
  std::vector<const ExperimentRecord*> wrong;
  std::deque<ExperimentRecord> first;  ///< these, of a campaign that is streamed
};

/// "150 MPM, 150 UD, 100 MPM+UD"; "named scenarios".
std::string kinds_text(const Study& study, const std::vector<KindCount>& kinds);

/// "11 infeasible, 0 failed, 9 of 150 loops unstable": the last where it is known, with ", 9 left out" where
/// the study leaves them out.
std::string endings_text(const Study& study, const Endings& endings);

/// `campaign` and `findings` must outlive the parts.
/// Of one that is streamed, it has `most` records of failures and of wrong verdicts.
SummaryContent summary_content(const Campaign& campaign, const StudyFindings& findings,
                               std::size_t most = kMostListed);

}  // namespace mpm
