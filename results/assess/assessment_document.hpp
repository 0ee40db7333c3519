#pragma once

#include "analysis/records/record_assessment.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// The verdict, what it costs, what each method says and how far to trust it.
Document assessment_document(const RecordAssessment& assessment);

}  // namespace mpm
