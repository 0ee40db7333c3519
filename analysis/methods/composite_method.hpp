#pragma once

#include <string>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// Two methods as one: the detector says whether a loop is flagged, and its score; the namer says the CV, its
/// source, the channels, the mismatch and the candidate. A loop in which the namer finds nothing has a
/// disturbance, as far as the namer tells sources: what is left of it where it looks for mismatches alone.
/// Its CV is then the worst one of the detector, or of the namer. Where the namer has no verdict nothing but
/// the CVs of the detector is named.
AssessmentMethodInfo composite_method(const std::string& name, const AssessmentMethodInfo& detector,
                                      const AssessmentMethodInfo& namer);

}  // namespace mpm
