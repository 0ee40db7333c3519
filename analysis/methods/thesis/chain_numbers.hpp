#pragma once

#include <memory>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_record.hpp"

// The numbers of the thesis's chain (`botelho`), each with its name and its place in a Diagnosis: the one
// list from which the method fills its answer, and from which a Diagnosis comes back out of an archive.

namespace mpm {

/// Does the method give the numbers of a Diagnosis? I_MPM tells.
bool diagnoses(const AssessmentForm& form);
/// The form of a method that does, for a diagnosis without a method: that of the basis case.
std::shared_ptr<const AssessmentForm> diagnosis_form(const Study& study);

/// The numbers of every study.
const std::vector<AssessmentNumberInfo>& chain_number_infos();
/// Those that a study of named scenarios has beside them, of every CV (CvDiagnosis): cv_sse, cv_i_mpm, ...
const std::vector<AssessmentNumberInfo>& scenario_number_infos();

/// Every number of a diagnosis, those of its CVs when it has any.
std::vector<AssessmentNumber> chain_numbers(const Diagnosis& diagnosis);

/// The diagnosis again; without vectors and without impact when there was no verdict.
Diagnosis diagnosis_of(const AssessmentRecord& record);

}  // namespace mpm
