#pragma once

#include <memory>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "scenarios/study/study.hpp"

// What a benchmark period of a record shows of the errors of its model: the plant's habit, and no fault.

namespace mpm {

/// The habit that the period `benchmark` shows. The period is a window of a loop of judged_loop(); errors of
/// the channels have the relative size `delta`, which is above 0.
std::shared_ptr<const ModelHabit> habit_of(const Study& study, double delta, const AssessedLoop& benchmark);

}  // namespace mpm
