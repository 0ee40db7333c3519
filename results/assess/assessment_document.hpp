#pragma once

#include "analysis/records/record_assessment.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// Makes the document of an assessment: the verdict, the cost, the answer of each method, and how far to
/// trust them.
Document assessment_document(const RecordAssessment& assessment);

}  // namespace mpm
