#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// Every method, the chain of the thesis first, added methods last.
const std::vector<AssessmentMethodInfo>& assessment_methods();

/// Adds an outside method, from the command line and before any run. Throws InputError for a name that
/// exists.
void add_assessment_method(AssessmentMethodInfo method);

/// The method of this name. Throws InputError, with the known names, when there is none.
const AssessmentMethodInfo& assessment_method(std::string_view name);

/// The names of the methods of a study, "all" spelled out. Throws InputError for an unknown method, one that
/// is named twice, or none.
std::vector<std::string> study_methods(const Study& study);

/// The same for a list of names; `key` is for messages.
std::vector<std::string> known_methods(const std::vector<std::string>& names, const std::string& key);

/// The names of all methods, in their order.
std::vector<std::string> assessment_method_names();

/// The tables [assessment.NAME] of all methods that have options, in their order.
std::vector<MethodOptionTable> method_option_tables();

}  // namespace mpm
