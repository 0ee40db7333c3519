#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/verdict.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// The verdicts on one experiment, which was run twice.
struct VerdictPair {
  std::int64_t index;
  Verdict before, now;
};

/// How the verdicts on the same experiments differ between two runs of a study.
///
/// A right verdict is lost when it is wrong now and also when there is none any more: an experiment that has
/// become infeasible, or has dropped out of the population, must not make a worse chain look better.
struct VerdictChanges {
  std::int64_t pairs = 0;           ///< experiments with a verdict in one of the runs at least
  std::vector<VerdictPair> lost;    ///< right before and not now
  std::vector<VerdictPair> gained;  ///< right now and not before
  McNemarTest test;                 ///< of these two numbers
};

/// One question to an experiment, such as location_verdict().
using Question = std::function<Verdict(const ExperimentRecord&)>;

/// Compares the experiments of `now` with the same ones of `before`, which may have more of them; both in the
/// order of the index.
/// @throws InputError for an experiment that `before` has not, or has with another fault
VerdictChanges verdict_changes(std::span<const ExperimentRecord> before,
                               std::span<const ExperimentRecord> now, const Question& question);

}  // namespace mpm
