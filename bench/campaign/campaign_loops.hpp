#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "bench/campaign/loop_farm.hpp"
#include "bench/execution/loop_keys.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/execution/stop_request.hpp"
#include "bench/outcome/outcome_bytes.hpp"
#include "bench/parts/loop_ranges.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

class ExperimentWork;
class LoopMemory;
struct KnownLoop;

/// How many experiments a run has. Throws InputError for a number that the study does not have.
std::int64_t experiment_count(const Study& study, const RunOptions& options);

/// How many calibration loops it has; 0 when the study asks for none.
std::int64_t calibration_loops(const Study& study);

/// The options by which calibration loops are run: nothing is audited, no loop is kept, and always all.
RunOptions calibration_options(RunOptions options);

/// The loops of a run, its experiments and its calibration loops: how they are run, what is stored of them,
/// and how records are made from that.
class CampaignLoops {
 public:
  /// `study` is as study_to_run() gave it. Throws InputError for options that make no campaign.
  CampaignLoops(Study study, RunOptions options);
  CampaignLoops(const CampaignLoops&) = delete;
  CampaignLoops& operator=(const CampaignLoops&) = delete;

  const Study& study() const { return study_; }
  const RunOptions& options() const { return options_; }
  std::int64_t experiments() const { return experiments_; }
  /// Only if the run calibrates.
  const Study& calibration() const { return *calibration_; }
  bool calibrates() const { return calibration_.has_value(); }
  /// Experiments and calibration loops.
  std::int64_t count() const { return experiments_ + calibration_loops(study_); }

  /// The keys of loops, and the reverse: experiments are counted first, and behind them calibration loops.
  std::vector<std::int64_t> keys(const LoopRanges& loops) const;
  LoopRanges loops(const std::vector<std::int64_t>& keys) const;

  /// Opens the shards in this folder. Errors: as ShardStore; InputError for one with an experiment that the
  /// campaign has not.
  ShardStore open(const std::filesystem::path& folder, const ShardStore::Warn& warn) const;
  /// A store without a folder.
  ShardStore in_memory() const { return ShardStore(shard_identity(study_, options_)); }

  /// How they are run, by methods that have learnt from `basis`, in threads or processes. What needs Ipopt
  /// goes from threads to worker processes: audits, and with `auto` the experiments in which some answer was
  /// not certified, as a whole. A loop whose worker process died is kept as failed. `warn` is told of audits
  /// that were lost. What `memory` knows, unless it is null, is not run: the methods that it has not heard
  /// are asked, and what is new goes there. The basis case, the memory and this object must outlive it.
  LoopWork work(const BasisCase& basis, const ShardStore::Warn& warn, LoopMemory* memory = nullptr) const;

  /// An outcome as it is kept, and as it was.
  LoopResult result(std::int64_t key, const ExperimentOutcome& outcome) const;
  ExperimentOutcome outcome(const ShardStore::Entry& entry) const;

  /// The records of the experiments, or of the calibration loops, that are in the store, which must outlive
  /// them as this object must. They throw Interrupted when a stop was requested, and as ShardStore::Next.
  RecordRange experiment_records(const ShardStore& store, const StopRequest& stop) const;
  RecordRange calibration_records(const ShardStore& store, const StopRequest& stop) const;

  /// Gives the campaign, which has its study and its info, the records in the store, as
  /// experiment_records() or, where it is asked for or the study names its scenarios, in memory; the audit;
  /// and the calibration, when all of its loops are there. Errors: as experiment_records(); InputError, which
  /// names both files, when two shards have one loop with different results.
  void take(Campaign& campaign, const ShardStore& store, const StopRequest& stop, bool in_memory) const;

 private:
  /// Of a loop that was run.
  LoopResult kept_result(std::int64_t key, ExperimentOutcome outcome, const LoopMemory* memory,
                         bool by_process) const;
  /// Of a loop that was known.
  LoopResult heard_result(std::int64_t key, KnownLoop known, const LoopMemory& memory,
                          ExperimentWork& work) const;
  const OutcomeBytes& bytes(std::int64_t key) const;
  RecordRange records(const ShardStore& store, const StopRequest& stop, std::int64_t first,
                      std::int64_t count) const;
  void require_one_result(const ShardStore& store) const;
  void take_audit(Campaign& campaign, const ShardStore& store) const;

  Study study_;
  RunOptions options_;
  std::int64_t experiments_;
  OutcomeBytes bytes_;
  std::optional<Study> calibration_;
  std::optional<OutcomeBytes> calibration_bytes_;
};

}  // namespace mpm
