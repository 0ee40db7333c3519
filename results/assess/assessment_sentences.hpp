#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/records/record_assessment.hpp"
#include "results/assess/record_verdict_text.hpp"
#include "scenarios/study/study.hpp"

// The assessment of a plant record, sentence by sentence.

namespace mpm {

/// The verdict in sentences, and the notes to it.
struct AssessmentText {
  RecordVerdictText verdict;
  std::vector<std::string> further = {};  ///< on the controller and the candidates
  std::vector<std::string> trust = {};    ///< how far to trust the verdict
  std::vector<std::string> repair = {};   ///< what the record tells about repairs of this and other channels
};

AssessmentText assessment_text(const RecordAssessment& assessment);
/// Returns the verdict, the notes on controller and candidates, and how far to trust it, in this order.
std::vector<std::string> verdict_sentences(const RecordAssessment& assessment);
/// Returns the verdict for an e-mail: at most ten lines.
std::string brief_text(const RecordAssessment& assessment);
/// Says how the controller of the study differs from the one that ran; empty if it is the same.
std::vector<std::string> controller_sentences(const RecordAssessment& assessment);
/// Returns the MV whose valve sticks, according to a method that names valves; empty if it names none.
std::string stuck_mv(const Study& study, const AssessmentRecord& said);
/// Returns words for a source that the answer names: "MPM", "valve of u2", or "-" for none.
std::string source_words(const Study& study, const AssessmentRecord& said, FaultSource source);
/// Returns the CVs that the repair of the verdict would worsen according to any of its predictions. There
/// must be a repair.
std::vector<std::string> worsened_by_repair(const RecordAssessment& assessment);

/// Returns number `row` of the answer with this name; NaN if the method has no such number.
double number_of_cv(const AssessmentRecord& said, std::string_view name, Eigen::Index row);
/// Returns what the method says is wrong with a CV that it flags; `none` if it does not flag the CV, or names
/// no source.
FaultSource source_of_cv(const AssessmentRecord& said, Eigen::Index cv);
/// Returns the MVs whose channels to a CV the method names.
std::vector<std::string> named_mvs(const Study& study, const AssessmentRecord& said, Eigen::Index cv);
/// Returns the logged signal that the method names for a CV that it flags; empty if it names none.
std::string named_candidate(const RecordAssessment& assessment, const AssessmentRecord& said,
                            Eigen::Index cv);
/// Returns the first and last stamp of a window of the study.
std::string window_text(const RecordAssessment& assessment, int window);

}  // namespace mpm
