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

/// Returns the number of experiments of a run. Throws InputError for a number that the study cannot have.
std::int64_t experiment_count(const Study& study, const RunOptions& options);

/// Returns the number of calibration loops of a run; 0 if the study asks for none.
std::int64_t calibration_loops(const Study& study);

/// Returns the options with which calibration loops run: all of them, without an audit, and without keeping
/// the loops.
RunOptions calibration_options(RunOptions options);

/// The loops of a run, which are its experiments and its calibration loops: decides how they run and what is
/// stored of them, and makes records from what is stored.
class CampaignLoops {
 public:
  /// `study` must come from study_to_run(). Throws InputError for options with which no campaign can run.
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

  /// Converts ranges of loops to keys, and back. Ranges count the experiments first, then the calibration
  /// loops.
  std::vector<std::int64_t> keys(const LoopRanges& loops) const;
  LoopRanges loops(const std::vector<std::int64_t>& keys) const;

  /// Opens the shards in this folder. Errors: as ShardStore; InputError for a shard with an experiment that
  /// the campaign does not have, unless Leftovers::renew discards it.
  ShardStore open(const std::filesystem::path& folder, const ShardStore::Warn& warn) const;
  /// A store without a folder.
  ShardStore in_memory() const { return ShardStore(shard_identity(study_, options_)); }

  /// Returns how the loops run, in threads or processes, with methods that have learnt from `basis`. Threads
  /// leave to worker processes what needs Ipopt: audits and, with the solver `auto`, each whole experiment in
  /// which an answer was not certified. A loop whose worker process died is stored as failed. `warn` is told
  /// of audits that were lost. If `memory` is not null, the loops that it knows are not run: only the methods
  /// whose answers it lacks are asked, and new results go into it. The basis case, the memory and this object
  /// must outlive the result.
  LoopWork work(const BasisCase& basis, const ShardStore::Warn& warn, LoopMemory* memory = nullptr) const;

  /// Converts an outcome to the result to store, and a stored entry back to its outcome.
  LoopResult result(std::int64_t key, const ExperimentOutcome& outcome) const;
  ExperimentOutcome outcome(const ShardStore::Entry& entry) const;

  /// The records of the experiments, or of the calibration loops, in the store. The store and this object
  /// must outlive them. Reading them throws Interrupted if a stop was requested, and the errors of
  /// ShardStore::Next.
  RecordRange experiment_records(const ShardStore& store, const StopRequest& stop) const;
  RecordRange calibration_records(const ShardStore& store, const StopRequest& stop) const;

  /// Fills a campaign that has its study and its info from the store, with three things: the records, as
  /// experiment_records(), or in memory if `in_memory` says so or the study names its scenarios; the audit;
  /// and the calibration, if all of its loops are there. Errors: as experiment_records(); InputError, which
  /// names both files, if two shards have different results for one loop.
  void take(Campaign& campaign, const ShardStore& store, const StopRequest& stop, bool in_memory) const;

 private:
  /// The result of a loop that was run.
  LoopResult kept_result(std::int64_t key, ExperimentOutcome outcome, const LoopMemory* memory,
                         bool by_process) const;
  /// The result of a loop that the memory knew; asks the methods whose answers it lacked.
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
