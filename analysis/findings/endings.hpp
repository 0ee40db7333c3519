#pragma once

#include <cstdint>

#include "analysis/experiment/experiment.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// How the experiments of a group ended.
struct Endings {
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  Rate infeasible;  ///< of the experiments that did not fail

  /// Counts an experiment; `infeasible` is a rate once all are counted.
  void add(ExperimentStatus status) {
    ++experiments;
    failed += status == ExperimentStatus::failed ? 1 : 0;
    infeasible.hits += status == ExperimentStatus::infeasible ? 1 : 0;
  }
  void finish(double confidence) { infeasible = rate(infeasible.hits, experiments - failed, confidence); }
};

}  // namespace mpm
