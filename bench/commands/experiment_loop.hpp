#pragma once

#include "analysis/sensitivity/nominal_output.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// The loop of an experiment that was diagnosed: the one in the archive, or the same once more.
LoopRecord loop_of(const Campaign& campaign, const ExperimentRecord& record);

/// y0 of the loop, from the S0 by which it was diagnosed. A loop without one of its own gets that of the
/// study.
NominalOutputs nominal_of(const Campaign& campaign, const ExperimentRecord& record, const LoopRecord& loop);

}  // namespace mpm
