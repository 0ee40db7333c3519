#pragma once

#include <cstdint>
#include <optional>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

/// How the experiments of a group ended.
struct Endings {
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  Rate infeasible;            ///< of the experiments that did not fail
  Rate unstable;              ///< of the experiments for which it is known whether the loop is stable
  std::int64_t excluded = 0;  ///< unstable experiments that the study leaves out

  /// Counts an experiment. When all are counted, finish() turns `infeasible` and `unstable` into rates.
  void add(const ExperimentRecord& record) {
    ++experiments;
    failed += record.status == ExperimentStatus::failed ? 1 : 0;
    infeasible.hits += record.status == ExperimentStatus::infeasible ? 1 : 0;
    excluded += record.status == ExperimentStatus::unstable ? 1 : 0;
    if (const std::optional<bool> stable = record.conditions.stable()) {
      ++unstable.total;
      unstable.hits += *stable ? 0 : 1;
    }
  }
  void finish(double confidence) {
    infeasible = rate(infeasible.hits, experiments - failed, confidence);
    unstable = rate(unstable.hits, unstable.total, confidence);
  }
};

}  // namespace mpm
