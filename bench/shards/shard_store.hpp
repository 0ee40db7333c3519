#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_set.hpp"

namespace mpm {

/// Keeps the finished experiments of a campaign on the disk until all of them are there. A shard is also
/// written when 64 MiB are waiting, so that stored loops do not fill the memory.
class ShardStore {
 public:
  using Warn = ShardSet::Warn;

  /// Opens the folder and reads the shards in it; `options` say what becomes of them, and how often one more
  /// is written. `study` must outlive it. `count` is the number of experiments of the campaign. A damaged
  /// shard is passed over with a warning; its experiments are missing.
  ///
  /// Throws InputError when shards lie there and are to be refused, belong to another run, or hold an
  /// experiment beyond `count`; ArchiveError when the folder cannot be made. No shard is changed then.
  ShardStore(const std::filesystem::path& folder, const RunOptions& options, const Study& study,
             std::int64_t count, const Warn& warn);

  /// What is in these shards, which lie elsewhere and stay as they are, is done too; before the first add().
  /// Errors: as the constructor.
  void take_others(const std::vector<std::filesystem::path>& shards, const Warn& warn) {
    set_.take_stock(shards, warn);
  }

  /// The experiments that no shard has, in the order of their index.
  std::vector<std::int64_t> missing() const { return set_.missing(); }
  /// Wall-clock time that the experiments in the shards took, in s: those of earlier runs until one is added.
  double seconds() const { return set_.seconds(); }

  /// Takes an outcome, and writes a shard when it is time. Throws ArchiveError when that fails.
  void add(const ExperimentOutcome& outcome);
  /// Writes what is still waiting.
  void flush();

  /// Puts what is in the shards, which were all flushed, into as few of them as there can be: many small
  /// files are a burden where they are kept. Damaged ones are removed. Killed in the middle it leaves
  /// experiments in two shards. Throws ArchiveError.
  void compact();

  /// The shards, of which none is waiting to be written.
  const ShardSet& set() const { return set_; }
  /// Gives each outcome once, shard by shard. Throws ArchiveError when a shard can no longer be read.
  void read(const ShardSet::Take& take) const { set_.read(take); }

 private:
  using Clock = std::chrono::steady_clock;

  ShardFolder folder_;
  ShardSet set_;
  std::chrono::duration<double> interval_;
  ShardBytes waiting_;
  Clock::time_point written_ = Clock::now();
};

}  // namespace mpm
