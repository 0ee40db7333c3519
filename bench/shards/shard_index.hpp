#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "bench/shards/shard.hpp"
#include "bench/shards/shard_set.hpp"

namespace mpm {

/// The outcomes in the shards of a campaign, in the order of their index. They are read one at a time
/// whenever they are asked for, and shards one after the other, so that of each one only its first index is
/// in memory, and the places of the outcomes of those that hold neighbours of the one at hand.
class ShardIndex {
 public:
  using Visit = std::function<void(const ExperimentOutcome&)>;
  /// The next outcome at each call, none behind the last one.
  using Next = std::function<std::optional<ExperimentOutcome>()>;

  /// `set` and its shards must outlive it. Throws ArchiveError when a shard can no longer be read,
  /// InputError, which names both files, when one experiment is not the same in two shards.
  explicit ShardIndex(const ShardSet& set);

  std::size_t size() const { return set_.count(); }
  /// Each experiment that is there once: where several shards have it, as the first of them does. The index
  /// must outlive it. It throws ArchiveError when a shard can no longer be read.
  Next one_by_one() const;
  void each(const Visit& visit) const;
  /// What several shards have, but for the outcomes that each() gives.
  void each_repeated(const Visit& visit) const;

 private:
  using Key = std::pair<std::int64_t, std::size_t>;  ///< index, and shard of the set
  struct Place {
    std::size_t shard;
    OutcomePlace outcome;
  };
  class Reader;
  class Sweep;

  std::vector<OutcomePlace> places_in(std::size_t shard) const;
  void compare_repeated() const;

  const ShardSet& set_;
  std::vector<Key> starts_;  ///< the first outcomes of the shards, in this order
};

}  // namespace mpm
