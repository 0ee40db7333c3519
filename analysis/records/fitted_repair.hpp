#pragma once

#include <optional>

#include "analysis/experiment/repair.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A channel identified again from a record in which every other channel may be off by the relative size
/// `delta`, and so may be those parameters of this one that keep to the model (fit_channel() with the
/// responses of relative_errors() and what no record can tell as unknown). Sizes are those against the model
/// of the study, whatever was wrong before the fault. With an onset the channel goes over from the model
/// about then, at once or along a line. Throws InputError as fit_channel().
ChannelRepair fitted_repair(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                            const Channel& channel, const std::optional<MismatchParameter>& only,
                            double delta, const std::optional<FaultOnset>& since);

}  // namespace mpm
