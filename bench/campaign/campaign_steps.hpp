#pragma once

#include <cstdint>

#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/experiment_series.hpp"

// What every way to a campaign has in common: in one go, in parts, and merged from parts.

namespace mpm {

/// How many experiments it has. Throws InputError for a number that the study has not.
std::int64_t experiment_count(const Study& study, const RunOptions& options);

/// The basis case, checked. With Ipopt it takes as long as an experiment, so that a stop does not wait for
/// it. Throws Interrupted with `tally`, and UnhealthyBasis as run_campaign().
BasisCase checked_basis(const Study& study, const RunOptions& options, const CampaignHooks& hooks,
                        const ExperimentTally& tally);

/// How, when and by which program; without the times.
CampaignInfo info_of(const Study& study, const RunOptions& options);

}  // namespace mpm
