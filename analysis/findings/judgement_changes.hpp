#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/world_counts.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// The results of one question in two runs of the same experiment.
struct JudgementPair {
  std::int64_t index;
  Correctness before, now;
  std::string cell = {};  ///< of the suite, "PLANT.FAMILY"; empty: of a study
};

/// How the judgements on the same experiments differ between two runs of a study.
///
/// A right judgement is lost if it is wrong now, and also if it is no longer judged: an experiment that has
/// become infeasible, or has dropped out of the population, must not make a worse chain look better.
struct JudgementChanges {
  std::int64_t pairs = 0;             ///< experiments that are judged in at least one of the runs
  std::vector<JudgementPair> lost;    ///< right before and not now
  std::vector<JudgementPair> gained;  ///< right now and not before
  WorldPairs clusters = {};           ///< all pairs; a cluster is a world

  /// Tests the hypothesis that a changed judgement is as likely lost as gained: clustered_mcnemar().
  McNemarTest test() const { return clusters.mcnemar(); }
  /// Counts a pair, unless it is judged in neither run.
  void add(JudgementPair pair, int cluster);
};

}  // namespace mpm
