#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// The order of kinds over the experiments of a study.
///
/// The kinds are interleaved so that any first N experiments keep the proportions of the whole study as well
/// as whole numbers can: a subset of a study is its beginning, and a longer run continues it.
class KindSequence {
 public:
  /// Throws InputError when all counts are zero or one is negative.
  explicit KindSequence(const ExperimentCounts& counts);

  ExperimentKind operator[](std::int64_t index) const;
  /// How many experiments before `index` are of its kind.
  std::int64_t earlier(std::int64_t index) const;

 private:
  std::vector<ExperimentKind> period_;
};

}  // namespace mpm
