#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_folder.hpp"

namespace mpm {

/// Keeps the finished experiments of a campaign on the disk until all of them are there. A shard is also
/// written when 64 MiB are waiting, so that stored loops do not fill the memory.
class ShardStore {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// Opens the folder and reads the shards in it; `options` say what becomes of them, and how often one more
  /// is written. `study` must outlive it. `count` is the number of experiments of the campaign. A damaged
  /// shard is passed over with a warning; its experiments are missing.
  ///
  /// Throws InputError when shards lie there and are to be refused, belong to another run, or hold an
  /// experiment beyond `count`; ArchiveError when the folder cannot be made. No shard is changed then.
  ShardStore(const std::filesystem::path& folder, const RunOptions& options, const Study& study,
             std::int64_t count, const Warn& warn);

  /// The experiments that no shard has, in the order of their index.
  std::vector<std::int64_t> missing() const;
  /// Wall-clock time that the experiments of the earlier runs took, in s.
  double earlier_seconds() const { return earlier_seconds_; }

  /// Takes an outcome, and writes a shard when it is time. Throws ArchiveError when that fails.
  void add(const ExperimentOutcome& outcome);
  /// Writes what is still waiting.
  void flush();

  /// Gives each outcome once, shard by shard. Throws ArchiveError when a shard can no longer be read.
  void read(const std::function<void(ExperimentOutcome)>& take) const;

 private:
  using Clock = std::chrono::steady_clock;

  void take_stock(const Warn& warn);

  ShardFolder folder_;
  ShardIdentity identity_;
  OutcomeBytes format_;
  std::chrono::duration<double> interval_;
  std::vector<bool> done_;                     ///< by index
  std::vector<std::filesystem::path> shards_;  ///< that are whole
  double earlier_seconds_ = 0.0;
  ShardBytes waiting_;
  Clock::time_point written_ = Clock::now();
};

}  // namespace mpm
