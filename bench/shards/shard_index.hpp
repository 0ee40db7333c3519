#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "bench/shards/shard_set.hpp"

namespace mpm {

/// The outcomes in the shards of a campaign, in the order of their index. They are read one at a time
/// whenever they are asked for, so that only their places are in memory, 16 bytes an experiment.
class ShardIndex {
 public:
  using Visit = std::function<void(const ExperimentOutcome&)>;

  /// `set` and its shards must outlive it. Throws ArchiveError when a shard can no longer be read,
  /// InputError, which names both files, when one experiment is not the same in two shards.
  explicit ShardIndex(const ShardSet& set);

  std::size_t size() const { return places_.size(); }
  /// Each experiment that is there once. Throws ArchiveError when a shard can no longer be read.
  void each(const Visit& visit) const;
  /// What several shards have, but for the outcomes that each() gives.
  void each_repeated(const Visit& visit) const;

 private:
  struct Place {
    std::int32_t shard;  ///< of the set; -1: none
    std::uint32_t size;  ///< bytes
    std::uint64_t begin;
  };
  class Reader;

  void find_places();
  void compare_repeated() const;

  const ShardSet& set_;
  std::vector<Place> places_;  ///< by index
  std::vector<Place> repeated_;
};

}  // namespace mpm
