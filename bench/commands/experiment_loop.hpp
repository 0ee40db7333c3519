#pragma once

#include "analysis/sensitivity/nominal_output.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// The loop of an experiment that was diagnosed: the one in the archive, or the same loop run again.
LoopRecord loop_of(const Campaign& campaign, const ExperimentRecord& record);

/// y0 of the loop, from the S0 with which it was diagnosed. A loop without an S0 of its own uses that of the
/// study.
NominalOutputs nominal_of(const Campaign& campaign, const ExperimentRecord& record, const LoopRecord& loop);

}  // namespace mpm
