#pragma once

#include <string>

#include "analysis/records/record_assessment.hpp"

namespace mpm {

/// Returns the content of assessment_document() as JSON for other programs.
std::string assessment_json(const RecordAssessment& assessment);

}  // namespace mpm
