#pragma once

#include <memory>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "base/row.hpp"

// The numbers of the thesis's chain (`botelho`) as rows of a Diagnosis. From this one list the method fills
// its answer and the archive its basis case. Readers of an answer find its numbers by their names.

namespace mpm {

/// Does the method give the numbers of a Diagnosis? Its form then has I_MPM.
bool diagnoses(const AssessmentForm& form);

/// The numbers that a study with so many CVs always has.
std::vector<Row<Diagnosis>> chain_rows(Eigen::Index cvs);
/// The additional numbers of every CV in a study of named scenarios: cv_sse, cv_i_mpm, ..., cv_acf_y at so
/// many lags.
std::vector<Row<CvDiagnosis>> scenario_rows(Eigen::Index lags);
/// All rows of a diagnosis of this study.
std::vector<Row<Diagnosis>> diagnosis_rows(const Study& study);

/// The descriptions of chain_rows() and of scenario_rows().
std::vector<AssessmentNumberInfo> chain_number_infos();
std::vector<AssessmentNumberInfo> scenario_number_infos();

/// Every number of a diagnosis, with those of its CVs if it has any.
std::vector<AssessmentNumber> chain_numbers(const Diagnosis& diagnosis);

/// What the chain says about one CV of a named scenario, from the numbers of its answer.
CvDiagnosis cv_diagnosis(const AssessmentRecord& said, Eigen::Index cv);

/// TSSE (6.21), the sum of the SSE of all CVs; NaN without a diagnosis of every CV.
double total_simulation_error(const AssessmentRecord& said);

}  // namespace mpm
