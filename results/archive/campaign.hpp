#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/calibration.hpp"
#include "analysis/findings/run_change.hpp"
#include "analysis/findings/study_findings.hpp"
#include "scenarios/loop/audit.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// How, when and by which program a run was made. None of it changes a result, except the solver.
struct CampaignInfo {
  std::string mpmbench_version;
  std::string git_sha;
  std::string created;  ///< ISO 8601, UTC
  std::string command;
  std::string outside_files = {};  ///< programs and FMUs of the study, with digests; empty: none
  std::string solver;
  double seconds = 0.0;        ///< wall-clock time
  int jobs = 1;                ///< experiments run at once
  double audit_share = 0.0;    ///< share of the steps that were audited
  double audit_seconds = 0.0;  ///< processor time of the audit
};

/// A method that has assessed the loops of a campaign, with the program and the command that ran it.
struct CampaignMethod {
  std::shared_ptr<const AssessmentForm> form;
  std::string mpmbench_version;
  std::string git_sha;
  std::string command;
};

/// Everything that a run of a study leaves behind.
///
/// `study.seed` is the seed that was used; it may differ from the one in `study.source`. `records` are the
/// experiments that were run, in the order of their index, each with an assessment of every method.
struct Campaign {
  Study study;
  CampaignInfo info;
  BasisCase basis;
  std::vector<CampaignMethod> methods;
  std::vector<ExperimentRecord> records;
  /// Replaces `records` if they are too many for the memory: findings_of(), write_archive() and
  /// summary_document() take them from here. Never set in a study of named scenarios.
  std::optional<RecordRange> streamed = {};
  /// What the methods say about the calibration loops, of which none is kept. It has no loops unless the
  /// study asks for them.
  Calibration calibration;
  std::vector<AuditedStep> audit;  ///< in the order of experiment and step
};

/// The forms of the methods of a campaign, and the names of the methods.
AssessmentForms forms_of(const Campaign& campaign);
std::vector<std::string> method_names(const Campaign& campaign);

/// Stores the command line by which the run was made and assessed.
void note_command(Campaign& campaign, const std::string& command_line);

/// Returns the position of the method that diagnoses (diagnoses()), or the number of methods if none does.
std::size_t chain_place(const Campaign& campaign);

/// Returns the records of a campaign, in memory or streamed.
RecordRange records_of(const Campaign& campaign);

/// Returns everything of a campaign that is compared with another run. `forms` is forms_of(campaign) and must
/// outlive the result.
StudyRun study_run(const Campaign& campaign, const AssessmentForms& forms);

/// Computes the findings of a campaign.
StudyFindings findings_of(const Campaign& campaign);

}  // namespace mpm
