#pragma once

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

inline constexpr const char* kModelCheck = "model-error";

/// Does the model explain the record, as well as a model does that is some percent off? With the errors a of
/// the channels of CV i that ChannelErrorFit has, what they leave of the simulation errors and their noise
/// v_i,
///
///   score_i = max(max |a| / 2, sqrt(left / v_i))
///
/// So both a channel that is further off and errors that no channel explains raise the score; without either
/// it is about 1. The controller plays no part in it. A method that only `assess` has: it knows `delta`, and
/// its threshold is that of the simulated records. With delta = 0 the model is exact.
AssessmentMethodInfo model_check_method(double delta);

}  // namespace mpm
