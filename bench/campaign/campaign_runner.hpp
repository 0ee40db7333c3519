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

/// Runs the basis case and checks it. With Ipopt it takes as long as an experiment, so a stop does not wait
/// for its end. Throws Interrupted with `done` of `count`; UnhealthyBasis if the self-check fails and the
/// options do not allow that, and always if the basis case does not run to its end.
BasisCase checked_basis(const Study& study, const RunOptions& options, const CampaignHooks& hooks,
                        std::int64_t done, std::int64_t count);

/// Returns how, when and by which program a study is run, without the durations.
CampaignInfo info_of(const Study& study, const RunOptions& options);

/// Runs the basis case, checks it, and then the experiments, in threads or processes. The records are in the
/// order of their index; an experiment whose worker process crashed is marked `failed` and the campaign goes
/// on. Basis case, records and audit are the same, bit for bit, for any number of jobs, and whether the
/// campaign was run in one go or resumed. Finished experiments wait in shards in the folder `shards`, or in
/// memory if there is no folder. The shards are still there on return: the caller may remove them once the
/// archive is written.
///
/// Throws InputError for options with which no campaign can run (threads for a solver that is not
/// thread-safe), UnhealthyBasis and Interrupted as checked_basis(), Interrupted as run_missing(), InputError
/// and ArchiveError of ShardStore.
Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks = {},
                      const std::optional<std::filesystem::path>& shards = {});

/// The same for any number of experiments: the records stay in the shards and can be read only until this
/// returns. `hooks.on_end` gets the streamed campaign; a stop request interrupts it as it does the
/// experiments.
void stream_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                     const std::filesystem::path& shards);

/// Runs the loops of a part that no shard in its folder has, as run_campaign() runs them. Leaves all loops of
/// the part there, in shards, with the description of the part. Keeps no record in memory. Returns how many
/// loops it ran. Errors: as run_campaign().
std::int64_t run_part(const PartFolder& part, const CampaignHooks& hooks);

}  // namespace mpm
