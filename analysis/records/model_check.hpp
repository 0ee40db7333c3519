#pragma once

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

inline constexpr const char* kModelCheck = "model-error";

/// Does the model explain the record, as well as a model does that is some percent off? Of each CV i with the
/// errors e = y - y_sim,
///
///   e = S a + n,    a ~ N(0, delta^2),    score_i = max(max |a| / (2 delta), sqrt(mean (e - S a)^2 / v_i)),
///
/// S the responses to relative errors of gain, time constants and dead time of every channel under the
/// recorded inputs, a their most likely values, and v_i half of the mean squared difference of successive
/// errors, which is their noise. So both a channel that is further off and errors that no channel explains
/// raise the score; without either it is about 1. The controller plays no part in it. A method that only
/// `assess` has: it knows delta, and its threshold is that of the simulated records. With delta = 0, S is
/// left out.
AssessmentMethodInfo model_check_method(double delta);

}  // namespace mpm
