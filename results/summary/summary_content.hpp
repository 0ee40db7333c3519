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

/// At most this many experiments are listed one by one in the summary for people.
inline constexpr std::size_t kMostListed = 10;

/// The content of both forms of the summary. It points into the campaign.
struct SummaryContent {
  explicit SummaryContent(const StudyFindings& of_campaign) : findings(of_campaign) {}

  const StudyFindings& findings;
  AuditSummary audit;
  std::int64_t fallbacks = 0;                ///< problems that Ipopt solved in place of the active-set method
  std::vector<S0Curve> s0_curves;            ///< this and the next two: empty unless the study perturbs S0
  std::vector<DiagonalFit> s0_fits;          ///< of the CVs at a soft limit
  std::vector<StructureFit> structure_fits;  ///< empty unless the study fixes MVs
  std::vector<KindCount> kinds;              ///< kinds in a study of random experiments
  std::vector<FailedExperiment> failures;    ///< all of them, as for `wrong_verdicts`
  std::vector<std::int64_t> wrong_verdicts;  ///< indices where Judgement::wrong() is true of the chain
  /// The records of these experiments; for a streamed campaign only the first ones.
  std::vector<const ExperimentRecord*> failed;
  std::vector<const ExperimentRecord*> wrong;
  std::deque<ExperimentRecord> first;  ///< holds these records for a streamed campaign
};

/// "150 MPM, 150 UD, 100 MPM+UD"; "named scenarios".
std::string kinds_text(const Study& study, const std::vector<KindCount>& kinds);

/// "11 infeasible, 0 failed, 9 of 150 loops unstable". The last part appears if it is known, and is followed
/// by ", 9 left out" if the study leaves such loops out.
std::string endings_text(const Study& study, const Endings& endings);

/// Collects the content. `campaign` and `findings` must outlive it. For a streamed campaign it holds at most
/// `most` records of failures, and as many of wrong verdicts.
SummaryContent summary_content(const Campaign& campaign, const StudyFindings& findings,
                               std::size_t most = kMostListed);

}  // namespace mpm
