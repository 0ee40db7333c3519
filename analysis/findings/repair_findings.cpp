#include "analysis/findings/repair_findings.hpp"

#include <algorithm>
#include <utility>

namespace mpm {

RepairTarget target_of(const ExperimentDraw& draw, const Channel& channel) {
  if (draw.mismatches.empty() && draw.parameters.empty())
    return RepairTarget::no_mismatch;
  const bool hit = std::any_of(draw.mismatches.begin(), draw.mismatches.end(), [&](const Mismatch& mismatch) {
    return mismatch.cv == channel.cv && mismatch.input == channel.mv;
  });
  return hit ? RepairTarget::mismatched : RepairTarget::another;
}

std::vector<RepairFindings> repair_findings(std::span<const RepairOutcome> outcomes, double confidence) {
  std::vector<RepairFindings> findings;
  for (const RepairTarget target :
       {RepairTarget::mismatched, RepairTarget::another, RepairTarget::no_mismatch}) {
    std::vector<double> now, repaired;
    std::int64_t better = 0, worse = 0;
    for (const RepairOutcome& outcome : outcomes) {
      if (outcome.target != target)
        continue;
      now.push_back(outcome.loss_now);
      repaired.push_back(outcome.loss_repaired);
      better += outcome.loss_repaired * kNoticeableChange < outcome.loss_now ? 1 : 0;
      worse += outcome.loss_repaired > outcome.loss_now * kNoticeableChange ? 1 : 0;
    }
    const auto loops = static_cast<std::int64_t>(now.size());
    findings.push_back({target, rate(better, loops, confidence), rate(worse, loops, confidence),
                        median_estimate(std::move(now), confidence),
                        median_estimate(std::move(repaired), confidence)});
  }
  return findings;
}

}  // namespace mpm
