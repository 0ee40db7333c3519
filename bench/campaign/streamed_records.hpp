#pragma once

#include "analysis/experiment/record_range.hpp"
#include "bench/execution/stop_request.hpp"
#include "bench/shards/shard_set.hpp"
#include "results/archive/campaign.hpp"

// Records that stay in the shards of a campaign, all of which are there, instead of in memory.

namespace mpm {

/// The records in these shards, which must outlive the range. It throws Interrupted when a stop was
/// requested, and as ShardIndex.
RecordRange records_in(const ShardSet& shards, const StopRequest& stop);

/// Gives the campaign, which has its study and its info, the records in these shards, as records_in() does,
/// or where the study names its scenarios in memory, and the audit. Errors: as records_in(); InputError for
/// an audit with two results.
void take_records(Campaign& campaign, const ShardSet& shards, const StopRequest& stop);

}  // namespace mpm
