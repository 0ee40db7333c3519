#pragma once

#include "analysis/assessment/assessment_method.hpp"

namespace mpm {

// The methods, each described in a source file of its own and listed in method_table.cpp.

AssessmentMethodInfo botelho_method();    ///< the chain of the thesis, appendix A2
AssessmentMethodInfo badwe2009_method();  ///< partial correlations, appendix A1.2

}  // namespace mpm
