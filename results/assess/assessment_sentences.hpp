#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/records/record_assessment.hpp"
#include "results/assess/record_verdict_text.hpp"
#include "scenarios/study/study.hpp"

// The assessment of a record of a plant, sentence by sentence.

namespace mpm {

/// The verdict in sentences, and the notes beside it.
struct AssessmentText {
  RecordVerdictText verdict;
  std::vector<std::string> further = {};  ///< of controller and candidates
  std::vector<std::string> trust = {};    ///< how far to trust it
  std::vector<std::string> repair = {};   ///< evidence of the record on the channel, and on others
};

AssessmentText assessment_text(const RecordAssessment& assessment);
/// All of them, in their order.
std::vector<std::string> verdict_sentences(const RecordAssessment& assessment);
/// The verdict for a mail: at most ten lines.
std::string brief_text(const RecordAssessment& assessment);
/// Is the controller of the study the one that ran? Empty: it is.
std::vector<std::string> controller_sentences(const RecordAssessment& assessment);
/// The MV whose valve sticks, if one does, by an answer that was asked for it; otherwise empty.
std::string stuck_mv(const Study& study, const AssessmentRecord& said);
/// "MPM", "valve of u2", "-" for none: a source that the answer names.
std::string source_words(const Study& study, const AssessmentRecord& said, FaultSource source);
/// The CVs that the repair of the verdict worsens by one of its predictions; there must be a repair.
std::vector<std::string> worsened_by_repair(const RecordAssessment& assessment);

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
/// First and last stamp of a window of the study.
std::string window_text(const RecordAssessment& assessment, int window);

}  // namespace mpm
