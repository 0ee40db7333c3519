#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/world_counts.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// What one question to an experiment came to, which was run twice.
struct JudgementPair {
  std::int64_t index;
  Correctness before, now;
};

/// How the judgements on the same experiments differ between two runs of a study.
///
/// A right one is lost when it is wrong now and also when it is not judged any more: an experiment that has
/// become infeasible, or has dropped out of the population, must not make a worse chain look better.
struct JudgementChanges {
  std::int64_t pairs = 0;             ///< experiments that are judged in one of the runs at least
  std::vector<JudgementPair> lost;    ///< right before and not now
  std::vector<JudgementPair> gained;  ///< right now and not before
  WorldPairs worlds = {};             ///< all of them, world by world
  McNemarTest test;                   ///< of these two numbers: clustered_mcnemar()
};

/// One question to an experiment, such as whether its CV is located.
using Question = std::function<Correctness(const ExperimentRecord&)>;

/// Compares the experiments of `now` with the same ones of `before`, which may have more of them; both in the
/// order of the index.
/// @throws InputError for an experiment that `before` has not, or has with another fault
JudgementChanges judgement_changes(const RecordRange& before, const RecordRange& now,
                                   const Question& question);

}  // namespace mpm
