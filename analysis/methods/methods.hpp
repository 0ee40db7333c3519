#pragma once

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

// The methods, each described in a source file of its own and listed in method_table.cpp.

AssessmentMethodInfo botelho_method();    ///< the chain of the thesis, appendix A2
AssessmentMethodInfo sun_method();        ///< model quality index, appendix A1.1
AssessmentMethodInfo badwe2009_method();  ///< partial correlations, appendix A1.2
AssessmentMethodInfo badwe2010_method();  ///< designed outputs, section 3.1
AssessmentMethodInfo yu_qin_method();     ///< variability against a benchmark, section 2.2.2, A1.3
AssessmentMethodInfo sse_method();        ///< simulation errors against a benchmark (4.17), (6.21)

}  // namespace mpm
