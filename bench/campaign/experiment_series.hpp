#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/outcome_collection.hpp"
#include "bench/execution/experiment_execution.hpp"
#include "bench/shards/shard_store.hpp"

namespace mpm {

/// execute_in_threads or execute_in_processes.
using Execution = decltype(&execute_in_threads);

/// How many experiments of a campaign are done, of how many.
struct ExperimentTally {
  std::int64_t done = 0, count = 0;

  ExperimentTally& operator+=(const ExperimentTally& other) {
    done += other.done;
    count += other.count;
    return *this;
  }
};

/// The first experiments of one study, which are run together: those of a campaign, or its calibration loops.
/// Without shards, outcomes wait in memory; with shards, on the disk, so that a campaign without kept loops
/// needs no more memory the longer it is.
class ExperimentSeries {
 public:
  /// `study` must outlive it. Errors: as ShardStore.
  ExperimentSeries(const Study& study, RunOptions options, std::int64_t count,
                   const std::optional<std::filesystem::path>& shards, const ShardStore::Warn& warn);

  /// Those that an earlier run has left are done.
  ExperimentTally tally() const;
  double earlier_seconds() const { return shards_ ? shards_->earlier_seconds() : 0.0; }

  /// Runs what is missing, counts it in `tally`, and brings all into order. Throws Interrupted when it was
  /// stopped before.
  OutcomeCollection run(const BasisCase& basis, Execution execute, const CampaignHooks& hooks,
                        ExperimentTally& tally);

 private:
  const Study& study_;
  RunOptions options_;
  std::int64_t count_;
  std::optional<ShardStore> shards_;
  std::vector<std::int64_t> missing_;
};

}  // namespace mpm
