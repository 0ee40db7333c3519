#include "analysis/statistics/least_effect.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr int kResamples = 200;

/// Returns the effect at which the isotonic regression reaches `power`; infinity if it never does. `trials`
/// are in ascending order of their effect.
double reached_at(const std::vector<EffectTrial>& trials, double power) {
  struct Block {
    double effect, hits, count;  ///< `effect` is the least of the block
  };
  std::vector<Block> blocks;
  for (const EffectTrial& trial : trials) {
    blocks.push_back({trial.effect, trial.found ? 1.0 : 0.0, 1.0});
    for (std::size_t last = blocks.size() - 1; last > 0; --last) {
      Block &before = blocks[last - 1], &after = blocks[last];
      const bool rises = before.hits * after.count < after.hits * before.count;
      if (rises && before.effect < after.effect)
        break;
      before.hits += after.hits;
      before.count += after.count;
      blocks.pop_back();
    }
  }
  for (const Block& block : blocks)
    if (block.hits >= power * block.count)
      return block.effect;
  return kInfinity;
}

}  // namespace

Estimate least_effect(std::vector<EffectTrial> trials, double power, double confidence, std::uint64_t seed) {
  Estimate least{.value = kNaN, .interval = {kNaN, kNaN}, .count = std::ssize(trials)};
  if (trials.empty())
    return least;
  const auto by_effect = [](const EffectTrial& a, const EffectTrial& b) { return a.effect < b.effect; };
  std::stable_sort(trials.begin(), trials.end(), by_effect);
  least.value = reached_at(trials, power);
  std::map<int, std::vector<EffectTrial>> by_cluster;
  for (const EffectTrial& trial : trials)
    by_cluster[trial.cluster].push_back(trial);
  std::vector<const std::vector<EffectTrial>*> clusters;
  for (const auto& cluster : by_cluster)
    clusters.push_back(&cluster.second);
  std::vector<double> found;
  for (int sample = 0; sample < kResamples; ++sample) {
    RandomStream stream(seed, static_cast<std::uint64_t>(sample), StreamId::bootstrap);
    std::vector<EffectTrial> drawn;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const std::vector<EffectTrial>& cluster =
          *clusters[static_cast<std::size_t>(stream.below(clusters.size()))];
      drawn.insert(drawn.end(), cluster.begin(), cluster.end());
    }
    std::stable_sort(drawn.begin(), drawn.end(), by_effect);
    found.push_back(reached_at(drawn, power));
  }
  std::sort(found.begin(), found.end());
  const auto at = [&found](double share) {  // no interpolation: some may be infinite
    return found[static_cast<std::size_t>(std::lround(share * static_cast<double>(found.size() - 1)))];
  };
  least.interval = {at(0.5 - 0.5 * confidence), at(0.5 + 0.5 * confidence)};
  return least;
}

}  // namespace mpm
