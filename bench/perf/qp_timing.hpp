#pragma once

#include <vector>

#include "bench/perf/qp_sequence.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

enum class StartOfSolve {
  warm,  ///< each program starts from the answer to the one before, the first from nothing
  cold,  ///< every program starts from nothing
};

/// The times of the solves of one sequence, and the accuracy of their answers.
///
/// The time of a program is the median over the passes, so that other load of the machine counts as little as
/// possible. The quantiles are over the programs of the sequence.
struct QpTimes {
  double median = 0.0;          ///< microseconds
  double p99 = 0.0;             ///< microseconds, quantile 0.99
  double max = 0.0;             ///< microseconds
  double kkt_residual = 0.0;    ///< the largest of all solved programs
  double iterations = 0.0;      ///< of the back end, mean over all solves
  std::int64_t not_solved = 0;  ///< programs of one pass without an answer, infeasible ones not counted
  std::int64_t infeasible = 0;  ///< programs of one pass
};

/// Median, p99 and max from the microseconds of each program (one line a program, one number a pass).
QpTimes program_times(const std::vector<std::vector<double>>& microseconds);

/// Solves a sequence again and again and times every program by itself.
class QpTiming {
 public:
  /// `sequence` has at least one program and must outlive this object.
  QpTiming(const QpSequence& sequence, const QpSolverFactory& factory, StartOfSolve start);

  /// Solves all programs once. Returns the seconds in `QpSolver::solve`, checks and certificate included.
  double pass();

  /// The times of the passes so far; there must be at least one.
  QpTimes times() const;

 private:
  const QpSequence& sequence_;
  std::unique_ptr<QpSolver> solver_;
  QpData data_;
  StartOfSolve start_;
  std::vector<std::vector<double>> microseconds_;  ///< one line a program, one number a pass
  QpTimes quality_;                                ///< of the last pass: everything but the times
};

}  // namespace mpm
