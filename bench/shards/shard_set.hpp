#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/shards/shard.hpp"

namespace mpm {

/// Shards on the disk, wherever they lie, that hold the finished experiments of one campaign.
class ShardSet {
 public:
  using Warn = std::function<void(const std::string&)>;
  using Take = std::function<void(ExperimentOutcome)>;

  /// `study` must outlive it. `count` is the number of experiments of the campaign.
  ShardSet(const RunOptions& options, const Study& study, std::int64_t count);

  /// Looks at more shards. A damaged one is passed over with a warning; its experiments are missing. Throws
  /// InputError for a shard of another run, or with an experiment beyond `count`.
  void take_stock(const std::vector<std::filesystem::path>& shards, const Warn& warn);

  /// One more shard, which was written just now, with experiments that nobody will ask missing() for.
  void add_written(const std::filesystem::path& shard, double seconds) {
    shards_.push_back(shard);
    seconds_ += seconds;
  }
  /// The same experiments lie in other shards now.
  void replace_shards(std::vector<std::filesystem::path> shards) { shards_ = std::move(shards); }

  /// The experiments that no shard has, in the order of their index.
  std::vector<std::int64_t> missing() const;
  /// Wall-clock time that the experiments in the shards took, in s.
  double seconds() const { return seconds_; }

  const ShardIdentity& identity() const { return identity_; }
  const OutcomeBytes& format() const { return format_; }

  /// How many experiments the campaign has.
  std::size_t count() const { return done_.size(); }
  /// Those that are whole.
  const std::vector<std::filesystem::path>& shards() const { return shards_; }

  /// Gives each outcome once, shard by shard. Throws ArchiveError when a shard can no longer be read.
  void read(const Take& take) const;

 private:
  ShardIdentity identity_;
  OutcomeBytes format_;
  std::vector<bool> done_;                     ///< by index
  std::vector<std::filesystem::path> shards_;  ///< that are whole
  double seconds_ = 0.0;
};

}  // namespace mpm
