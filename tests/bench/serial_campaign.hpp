#pragma once

#include "bench/execution/run_options.hpp"
#include "results/archive/campaign.hpp"

namespace mpm::testing {

/// A campaign as it is meant: the basis case, then one experiment after the other in the calling thread, and
/// the calibration loops. What run_campaign() must equal in basis case, records and audit, bit for bit, with
/// any number of threads or processes, and resumed at any place. For options that run_campaign() takes; asks
/// for no health of the basis case, and leaves `info` empty.
Campaign run_serially(Study study, const RunOptions& options);

}  // namespace mpm::testing
