#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/outcome_collection.hpp"
#include "bench/execution/experiment_execution.hpp"
#include "bench/shards/shard_store.hpp"

namespace mpm {

/// execute_in_threads, execute_in_processes, or what gives out loops of an archive.
using Execution = std::function<void(const ExecutionPlan&, const StopRequest&, const OutcomeSink&)>;

/// How many experiments of a campaign are done, of how many.
struct ExperimentTally {
  std::int64_t done = 0, count = 0;

  ExperimentTally& operator+=(const ExperimentTally& other) {
    done += other.done;
    count += other.count;
    return *this;
  }
};

/// Which experiments of a study are to be run.
struct WantedLoops {
  std::int64_t count = 0;             ///< of the campaign
  std::vector<std::int64_t> indices;  ///< these of them, in ascending order
};

/// Experiments of one study that are run together: those of a campaign, or its calibration loops. Without
/// shards, outcomes wait in memory; with shards, on the disk, so that it needs no more memory the longer it
/// is, until they are collected.
class ExperimentSeries {
 public:
  /// `study` must outlive it. `others` are shards that lie elsewhere and stay there; with a folder only.
  /// Errors: as ShardStore.
  ExperimentSeries(const Study& study, RunOptions options, const WantedLoops& wanted,
                   const std::optional<std::filesystem::path>& shards, const ShardStore::Warn& warn,
                   const std::vector<std::filesystem::path>& others = {});

  /// Of what is wanted; what an earlier run has left is done.
  ExperimentTally tally() const { return {count_ - std::ssize(missing_), count_}; }
  double earlier_seconds() const { return earlier_seconds_; }

  /// Runs what is missing, and counts it in `tally`; the methods have learnt from the basis case of
  /// `basis_study`. Throws Interrupted when it was stopped before.
  void run(const Study& basis_study, const BasisCase& basis, const Execution& execute,
           const CampaignHooks& hooks, ExperimentTally& tally);

  /// Brings the outcomes into order, all of which must be there.
  OutcomeCollection collect();

  /// The same, but the records stay where they wait: in shards those that are there, which must outlive the
  /// range; in memory those that were not run have no assessments. Errors: as records_in().
  RecordRange records(const StopRequest& stop);

  /// The shards, in which all outcomes must be. Only of a series with shards.
  const ShardSet& shards() const { return shards_->set(); }

  /// Makes as few shards as there can be.
  void compact();

 private:
  const Study& study_;
  RunOptions options_;
  std::int64_t count_;  ///< that are wanted
  std::optional<ShardStore> shards_;
  std::optional<OutcomeCollection> outcomes_;  ///< without shards
  std::int64_t all_;                           ///< experiments of the campaign
  std::vector<std::int64_t> missing_;
  double earlier_seconds_ = 0.0;
};

}  // namespace mpm
