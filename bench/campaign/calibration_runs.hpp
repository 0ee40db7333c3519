#pragma once

#include <cstdint>

#include "bench/execution/run_options.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// The options by which the calibration loops of a campaign are run: nothing is audited, no loop is kept, and
/// always all of them.
RunOptions calibration_options(RunOptions options);

/// How many calibration loops a run of this study has; 0 when it asks for none.
std::int64_t calibration_loops(const Study& study);

}  // namespace mpm
