#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/statistics/clustered_rate.hpp"
#include "analysis/statistics/share_difference.hpp"

namespace mpm {

/// Counts of one type, one for each world, because the loops of a world share its model errors and its
/// benchmark. A study without worlds has all loops in one world.
template <class Counts>
class OfWorlds {
 public:
  Counts& of(int world) {
    const auto place = static_cast<std::size_t>(std::int64_t{world} + 1);  // the exact world comes first
    if (place >= worlds_.size())
      worlds_.resize(place + 1);
    return worlds_[place];
  }
  const std::vector<Counts>& all() const { return worlds_; }

 private:
  std::vector<Counts> worlds_;
};

/// Trials and hits.
class WorldCount {
 public:
  void add(int world, bool hit) {
    ClusterCount& count = counts_.of(world);
    ++count.total;
    count.hits += hit ? 1 : 0;
  }
  void add(int world, const ClusterCount& more) {
    ClusterCount& count = counts_.of(world);
    count.total += more.total;
    count.hits += more.hits;
  }
  /// `further_variance` as in Rate.
  Rate rate(double confidence, double further_variance = 0.0) const {
    return clustered_rate(counts_.all(), confidence, further_variance);
  }

 private:
  OfWorlds<ClusterCount> counts_;
};

/// Values between 0 and 1.
class WorldMean {
 public:
  void add(int world, double value) {
    ClusterSum& sum = sums_.of(world);
    sum.sum += value;
    ++sum.count;
  }
  Estimate mean(double confidence) const { return clustered_mean(sums_.all(), confidence); }

 private:
  OfWorlds<ClusterSum> sums_;
};

/// The same cases counted twice.
class WorldPairs {
 public:
  void add(int world, bool in_first, bool in_second) { counts_.of(world).add(in_first, in_second); }
  PairedCounts sum() const { return pooled_counts(counts_.all()); }
  ShareDifference difference(double confidence) const {
    return clustered_difference(counts_.all(), confidence);
  }
  McNemarTest mcnemar() const { return clustered_mcnemar(counts_.all()); }

 private:
  OfWorlds<PairedCounts> counts_;
};

}  // namespace mpm
