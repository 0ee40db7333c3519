#pragma once

#include <memory>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "base/row.hpp"

// The numbers of the thesis's chain (`botelho`) as rows of a Diagnosis: the one list from which the method
// fills its answer and the archive its basis case. Whoever reads an answer takes its numbers by their names.

namespace mpm {

/// Does the method give the numbers of a Diagnosis? I_MPM tells.
bool diagnoses(const AssessmentForm& form);

/// The numbers of every study that has so many CVs.
std::vector<Row<Diagnosis>> chain_rows(Eigen::Index cvs);
/// Those that a study of named scenarios has beside them, of every CV: cv_sse, cv_i_mpm, ..., cv_acf_y at so
/// many lags.
std::vector<Row<CvDiagnosis>> scenario_rows(Eigen::Index lags);
/// All rows of a diagnosis of this study.
std::vector<Row<Diagnosis>> diagnosis_rows(const Study& study);

/// The descriptions of chain_rows() and of scenario_rows().
std::vector<AssessmentNumberInfo> chain_number_infos();
std::vector<AssessmentNumberInfo> scenario_number_infos();

/// Every number of a diagnosis, those of its CVs when it has any.
std::vector<AssessmentNumber> chain_numbers(const Diagnosis& diagnosis);

/// What the chain says about one CV of a named scenario, from the numbers of its answer.
CvDiagnosis cv_diagnosis(const AssessmentRecord& said, Eigen::Index cv);

/// TSSE (6.21), the sum of the SSE of all CVs; NaN without a diagnosis of every CV.
double total_simulation_error(const AssessmentRecord& said);

}  // namespace mpm
