#include "analysis/findings/judgement_changes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

/// What is kept of an experiment of the earlier run.
struct Earlier {
  std::int64_t index;
  ExperimentKind kind;
  Eigen::Index cv;
  Correctness judgement;
};

std::string fault(ExperimentKind kind, Eigen::Index cv) {
  return fmt::format("{} on CV {}", to_string(kind), cv);
}

/// The same experiment in the earlier run.
const Earlier& counterpart(const std::vector<Earlier>& before, const ExperimentDraw& now) {
  const auto found = std::lower_bound(before.begin(), before.end(), now.index,
                                      [](const Earlier& each, std::int64_t i) { return each.index < i; });
  if (found == before.end() || found->index != now.index)
    throw InputError("experiments", fmt::format("number {}, which the earlier run has not", now.index),
                     "experiments of the earlier run");
  if (found->kind != now.kind || found->cv != now.true_cv())
    throw InputError(fmt::format("experiment {}", now.index), fault(now.kind, now.true_cv()),
                     fmt::format("those of the earlier run, {}", fault(found->kind, found->cv)));
  return *found;
}

}  // namespace

JudgementChanges judgement_changes(const RecordRange& before, const RecordRange& now,
                                   const Question& question) {
  std::vector<Earlier> earlier;
  before.each([&](const ExperimentRecord& record) {
    earlier.push_back({record.draw.index, record.draw.kind, record.draw.true_cv(), question(record)});
  });
  JudgementChanges changes;
  now.each([&](const ExperimentRecord& record) {
    const JudgementPair pair{record.draw.index, counterpart(earlier, record.draw).judgement,
                             question(record)};
    if (pair.before == Correctness::not_judged && pair.now == Correctness::not_judged)
      return;
    ++changes.pairs;
    const bool was = pair.before == Correctness::right, is = pair.now == Correctness::right;
    changes.worlds.add(record.draw.world, was, is);
    if (was && !is)
      changes.lost.push_back(pair);
    if (is && !was)
      changes.gained.push_back(pair);
  });
  changes.test = changes.worlds.mcnemar();
  return changes;
}

}  // namespace mpm
