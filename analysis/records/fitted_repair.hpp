#pragma once

#include <optional>

#include "analysis/experiment/repair.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Identifies a channel again from a record in which every other channel may be off by the relative size
/// `delta`, and so may the parameters of this channel that are not fitted. fit_channel() gets the responses
/// of relative_errors() and what no record can tell as unknowns. Sizes are relative to the model of the
/// study, whatever was wrong before the fault. With an onset the channel changes from the model to the fitted
/// channel about then, at once or along a line. Throws InputError as fit_channel().
ChannelRepair fitted_repair(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                            const Channel& channel, const std::optional<MismatchParameter>& only,
                            double delta, const std::optional<FaultOnset>& since);

}  // namespace mpm
