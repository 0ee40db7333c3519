#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// Every method of assessment, the chain of the thesis first.
const std::vector<AssessmentMethodInfo>& assessment_methods();

/// The method of this name. Throws InputError, with the known names, when there is none.
const AssessmentMethodInfo& assessment_method(std::string_view name);

/// The names of all methods, in their order.
std::vector<std::string> assessment_method_names();

}  // namespace mpm
