#pragma once

#include <string>

#include "analysis/records/record_assessment.hpp"

namespace mpm {

/// assessment_document() for programs.
std::string assessment_json(const RecordAssessment& assessment);

}  // namespace mpm
