#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// Counts of verdicts: how often a case of each true class got each predicted class.
class ConfusionMatrix {
 public:
  /// Counts are whole numbers: row = true class, column = predicted class.
  using Counts = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic>;

  /// No cases yet. Classes are 0 ... classes - 1. @throws InputError unless classes is 1 or more
  explicit ConfusionMatrix(Eigen::Index classes);

  /// Counts one case. @throws InputError for a class outside 0 ... classes - 1
  void add(Eigen::Index true_class, Eigen::Index predicted_class);

  /// Number of classes.
  Eigen::Index classes() const { return counts_.rows(); }
  /// All counts, classes x classes.
  const Counts& counts() const { return counts_; }
  /// Number of cases.
  std::int64_t total() const { return counts_.sum(); }
  /// Number of cases with the right verdict, the trace.
  std::int64_t hits() const { return counts_.trace(); }

  /// Share of right verdicts in all cases, with Wilson's interval. @throws InputError unless 0 < confidence <
  /// 1
  Rate accuracy(double confidence = 0.95) const;
  /// Share of right verdicts in the cases of one true class (the diagonal entry over the sum of its row),
  /// with Wilson's interval. @throws InputError for a class or confidence out of range
  Rate recall(Eigen::Index true_class, double confidence = 0.95) const;

 private:
  void require_class(const char* quantity, Eigen::Index found) const;

  Counts counts_;
};

}  // namespace mpm
