#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/repair.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/repair_prospects.hpp"
#include "analysis/records/channel_information.hpp"
#include "analysis/records/controller_check.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/record_verdict.hpp"
#include "results/document/document.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The calibration run behind the answers on a record.
struct RecordTrial {
  std::string archive;  ///< where it is kept
  std::int64_t loops = 0;
  std::vector<TrialFindings> methods;  ///< in the order of the answers
  TrialFindings model;                 ///< of RecordAssessment::model
};

/// How probable each kind of fault is, given that there is one; they sum to 1.
struct FaultOdds {
  double mpm, ud, mpm_ud;
  double other;  ///< a valve that sticks
};

/// What the methods say of a record of a plant, and what a person needs to judge it.
struct RecordAssessment {
  std::string file;     ///< of the record, its name only
  std::string version;  ///< of the program
  Study study;          ///< recorded_study()
  PlantRecord record;
  AssessedLoop loop;
  Eigen::MatrixXd y0;                  ///< ny x N, the nominal loop under the recorded disturbances
  Eigen::Index unjudged = 0;           ///< samples at the start that only fill the memory of the model
  std::vector<AssessmentRecord> said;  ///< by each method; the first one is the verdict
  AssessmentRecord model;              ///< model_check_method()
  std::vector<UnexplainedCv> unexplained = {};
  AssessmentRecord odds = {};  ///< `likelihood`, of a record with a fault: of which kind it is
  ControllerCheck controller;
  double model_error = 0.0;  ///< RecordFrame::model_error
  DataOptions data;          ///< of the study, by which the record was read
  std::optional<PromisedRepair> repair;
  std::optional<ChannelInformation> information = {};  ///< of the channel of the repair
  std::vector<RepairProspect> prospects = {};          ///< ranked(), of a fault that may be the model's
  std::string no_repair;  ///< why there is none, of a verdict that names a channel; otherwise empty
  std::optional<RecordTrial> trial;
  std::string no_trial;  ///< why there is none
  std::vector<std::string> warnings;

  const AssessmentRecord& verdict() const { return said.front(); }
  /// What the method in this place made of the simulated records; null without any.
  const TrialFindings* trial_of(std::size_t method) const {
    return trial ? &trial->methods[method] : nullptr;
  }
  RecordAnswers answers_of(std::size_t method) const;
  RecordVerdict found() const { return record_verdict(answers_of(0), controller); }
  /// None of a record without a fault, or without an answer.
  std::optional<FaultOdds> fault_odds() const;
  /// Of the channel that the verdict names; null where it was not run.
  const RepairProspect* named_prospect() const;
};

/// The verdict in sentences.
struct AssessmentText {
  std::vector<std::string> asked;
  std::vector<std::string> found;  ///< what it costs and where, what it is, which channel and parameter
  std::vector<std::string> to_do;
  std::vector<std::string> sure;  ///< how far to trust it
};

AssessmentText verdict_text(const RecordAssessment& assessment);
/// All of them but what was asked, in their order.
std::vector<std::string> verdict_sentences(const RecordAssessment& assessment);
/// Is the controller of the study the one that ran? Empty: it is.
std::vector<std::string> controller_sentences(const RecordAssessment& assessment);
/// The CV that a person looks at first: that of the verdict, or the one that the model explains least.
Eigen::Index worst_cv(const RecordAssessment& assessment);

/// The MV whose valve sticks, if one does, by an answer that was asked for it; otherwise empty.
std::string stuck_mv(const Study& study, const AssessmentRecord& said);
/// "MPM", "valve of u2", "-" for none: a source that the answer names.
std::string source_words(const Study& study, const AssessmentRecord& said, FaultSource source);
/// The CVs that the repair of the verdict worsens by one of its predictions; there must be a repair.
std::vector<std::string> worsened_by_repair(const RecordAssessment& assessment);

/// The verdict, what it costs, what each method says and how far to trust it.
Document assessment_document(const RecordAssessment& assessment);
/// The same for programs.
std::string assessment_json(const RecordAssessment& assessment);

/// Number `row` of the answer under this name; NaN when the method has no such number.
double number_of_cv(const AssessmentRecord& said, std::string_view name, Eigen::Index row);
/// What the method says is wrong with a CV that it flags; none of a CV that it does not, or when it does not
/// tell.
FaultSource source_of_cv(const AssessmentRecord& said, Eigen::Index cv);
/// The MVs whose channels to a CV the method names.
std::vector<std::string> named_mvs(const Study& study, const AssessmentRecord& said, Eigen::Index cv);
/// The logged signal that the method names for a CV that it flags; empty for none.
std::string named_candidate(const RecordAssessment& assessment, const AssessmentRecord& said,
                            Eigen::Index cv);
/// "gain of y2/u1 x 0.62 (0.55 to 0.7)"
std::string mismatch_sentence(const Study& study, const NamedMismatch& named);
/// First and last stamp of a window of the study.
std::string window_text(const RecordAssessment& assessment, int window);

}  // namespace mpm
