#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/parts/part_folder.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// The basis case of the study failed its self-check: its verdicts would mean nothing.
class UnhealthyBasis : public InputError {
 public:
  using InputError::InputError;
};

/// The basis case, checked. With Ipopt it takes as long as an experiment, so that a stop does not wait for
/// it: it throws Interrupted with `done` of `count`, and UnhealthyBasis as above (or, when the basis case
/// does not even run through, in any case).
BasisCase checked_basis(const Study& study, const RunOptions& options, const CampaignHooks& hooks,
                        std::int64_t done, std::int64_t count);

/// How, when and by which program; without the times.
CampaignInfo info_of(const Study& study, const RunOptions& options);

/// Runs the basis case, checks it, and then the experiments, in threads or processes. The records stand in
/// the order of their index; an experiment whose worker process crashed is marked `failed` and the campaign
/// goes on. Basis case, records and audit are the same, bit for bit, for any number of jobs, and whether the
/// campaign was run in one go or resumed. Finished experiments wait in shards in the folder
/// `shards`, in memory without one. The shards are still there when it returns: they may go when the archive
/// is written.
///
/// Throws InputError for options that make no campaign (threads for a solver that is not thread-safe),
/// UnhealthyBasis and Interrupted as checked_basis(), Interrupted as run_missing(), InputError and
/// ArchiveError of ShardStore.
Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks = {},
                      const std::optional<std::filesystem::path>& shards = {});

/// The same for any number of experiments: the records stay in the shards, and are no more when it returns.
/// `hooks.on_end` gets the campaign, streamed, and may be interrupted as the experiments are.
void stream_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                     const std::filesystem::path& shards);

/// Runs those of the loops of a part that no shard in its folder has, as run_campaign() runs them, and leaves
/// all of them there, in shards, with the description of the part. No record is kept in memory. Returns how
/// many were run. Errors: as run_campaign().
std::int64_t run_part(const PartFolder& part, const CampaignHooks& hooks);

}  // namespace mpm
