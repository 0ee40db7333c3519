#include "analysis/findings/method_pairs.hpp"

#include <array>
#include <span>
#include <utility>

#include "analysis/findings/world_counts.hpp"
#include "analysis/statistics/holm.hpp"

namespace mpm {
namespace {

struct PairCounts {
  MethodPair pair;
  WorldPairs right_in = {};

  void add(const Study& study, const ExperimentRecord& record) {
    const AssessmentRecord& a = record.assessments[pair.first];
    const AssessmentRecord& b = record.assessments[pair.second];
    if (!a.answered() || !b.answered())
      return;
    const bool right = to_be_flagged(study, record, pair.truth);
    ++pair.loops;
    right_in.add(record.draw.world, a.flagged == right, b.flagged == right);
  }

  MethodPair result() const {
    MethodPair found = pair;
    found.test = right_in.mcnemar();
    return found;
  }
};

/// Corrects the p-values of the pairs of one truth. Pairs without a loop in common test nothing.
void correct(std::span<MethodPair> pairs) {
  std::vector<double> p;
  for (const MethodPair& pair : pairs)
    if (pair.loops > 0)
      p.push_back(pair.test.p_two_sided);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (MethodPair& pair : pairs)
    if (pair.loops > 0)
      pair.p_holm = *next++;
}

constexpr std::array kPairTruths{FlagTruth::fault, FlagTruth::impact};

/// All pairs, those of one truth after those of another.
struct AllPairCounts {
  const Study& study;
  std::vector<PairCounts> pairs = {};

  void add(const ExperimentRecord& record) {
    for (PairCounts& pair : pairs)
      pair.add(study, record);
  }
  std::vector<MethodPair> result() const {
    std::vector<MethodPair> found;
    for (const PairCounts& pair : pairs)
      found.push_back(pair.result());
    const std::size_t of_truth = found.size() / kPairTruths.size();
    for (std::size_t begin = 0; begin < found.size(); begin += of_truth)
      correct(std::span(found).subspan(begin, of_truth));
    return found;
  }
};

}  // namespace

Collector<std::vector<MethodPair>> pair_collector(const Study& study, std::size_t methods) {
  AllPairCounts counts{study};
  for (const FlagTruth truth : kPairTruths)
    for (std::size_t first = 0; first < methods; ++first)
      for (std::size_t second = first + 1; second < methods; ++second)
        counts.pairs.push_back({{truth, first, second, 0, {}, 1.0}});
  return collector_of(std::move(counts));
}

}  // namespace mpm
