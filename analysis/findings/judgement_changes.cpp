#include "analysis/findings/judgement_changes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

std::string fault(const ExperimentDraw& draw) {
  return fmt::format("{} on CV {}", to_string(draw.kind), draw.true_cv());
}

/// The record of the same experiment in an earlier run.
const ExperimentRecord& counterpart(std::span<const ExperimentRecord> before, const ExperimentRecord& now) {
  const auto found =
      std::lower_bound(before.begin(), before.end(), now.draw.index,
                       [](const ExperimentRecord& record, std::int64_t i) { return record.draw.index < i; });
  if (found == before.end() || found->draw.index != now.draw.index)
    throw InputError("experiments", fmt::format("number {}, which the earlier run has not", now.draw.index),
                     "experiments of the earlier run");
  if (found->draw.kind != now.draw.kind || found->draw.true_cv() != now.draw.true_cv())
    throw InputError(fmt::format("experiment {}", now.draw.index), fault(now.draw),
                     fmt::format("what the earlier run has, {}", fault(found->draw)));
  return *found;
}

}  // namespace

JudgementChanges judgement_changes(std::span<const ExperimentRecord> before,
                                   std::span<const ExperimentRecord> now, const Question& question) {
  JudgementChanges changes;
  for (const ExperimentRecord& record : now) {
    const JudgementPair pair{record.draw.index, question(counterpart(before, record)), question(record)};
    if (pair.before == Correctness::not_judged && pair.now == Correctness::not_judged)
      continue;
    ++changes.pairs;
    if (pair.before == Correctness::right && pair.now != Correctness::right)
      changes.lost.push_back(pair);
    if (pair.before != Correctness::right && pair.now == Correctness::right)
      changes.gained.push_back(pair);
  }
  changes.test = mcnemar_test(static_cast<std::int64_t>(changes.lost.size()),
                              static_cast<std::int64_t>(changes.gained.size()));
  return changes;
}

}  // namespace mpm
