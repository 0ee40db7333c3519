#pragma once

#include <string>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// Two methods as one: the detector flags a loop and gives its score; the namer gives the CV, its source, the
/// channels, the mismatch and the candidate. If the namer tells sources but finds no fault in a flagged loop,
/// the source is a disturbance, because a namer may look only for mismatches. The CV is then the worst one of
/// the detector or, if the detector has none, of the namer. If the namer has no verdict, only the CVs of the
/// detector are named.
AssessmentMethodInfo composite_method(const std::string& name, const AssessmentMethodInfo& detector,
                                      const AssessmentMethodInfo& namer);

}  // namespace mpm
