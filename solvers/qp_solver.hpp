#pragma once

#include <functional>
#include <memory>

#include "base/non_finite.hpp"
#include "solvers/lanes/lane_program.hpp"
#include "solvers/qp.hpp"

namespace mpm {

/// Largest KKT residual of an answer that is called `solved`, by any back end.
inline constexpr double kSolvedKktResidual = 1e-7;

/// Largest KKT residual of an answer that is called certified, unless the answer is so large that its
/// rounding is more than that. The active-set method reaches 1e-10 where the problem allows it.
inline constexpr double kCertifiedKktResidual = 1e-9;

/// How far an answer may miss a limit through rounding alone, relative to the largest number of x and A x: 32
/// times the unit roundoff. In a loop that had run away, rows of 20 terms missed their limits by 1 to 4 units
/// in the last place.
inline constexpr double kAnswerRounding = 0x1p-47;

/// Solves a sequence of quadratic programs that share one structure, each warm-started from the one before.
///
/// The public `solve` checks its input and certifies the answer. An answer with a KKT residual above
/// kSolvedKktResidual is a `numerical_error`, whatever the back end says. An answer is `certified` if its
/// residual is at most kCertifiedKktResidual, or kAnswerRounding times the largest number of x and A x: with
/// doubles, an answer of 1e7, as in a loop that runs away, cannot come nearer to its limits. Back ends
/// implement `do_solve` only. A solver belongs to one controller and is not shared between threads.
class QpSolver {
 public:
  /// Throws InputError when the structure is not valid.
  explicit QpSolver(std::shared_ptr<const QpStructure> structure);
  virtual ~QpSolver() = default;
  QpSolver(const QpSolver&) = delete;
  QpSolver& operator=(const QpSolver&) = delete;

  /// The minimiser for `data`; the reference stays valid until the next call. An infeasible problem is a
  /// status; bad input (see QpData::validate) throws InputError. Allocates nothing of its own.
  const QpResult& solve(const QpData& data);

  /// The same, starting from the guess `x` (n) and not from the last answer. A back end that starts from a
  /// set of active limits and not from a point ignores `x`.
  const QpResult& solve_from(const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& x);

  /// Sets the processor seconds that Ipopt may take for one problem from now on, all of its runs together; a
  /// problem that needs more has the status `time_limit`. Infinite at first. The active-set method limits its
  /// steps instead and ignores this limit.
  void set_time_limit(double seconds) { time_limit_ = seconds; }

  /// Forgets the warm start, so that the next answer depends on its problem alone.
  void reset();

  const QpStructure& structure() const { return *structure_; }

  /// The answer of the last solve.
  const QpResult& result() const { return result_; }

 protected:
  double time_limit() const { return time_limit_; }
  /// The structure for the kernels.
  const std::shared_ptr<const LaneProgram>& lanes() const { return workspace_->lanes; }
  /// True if the KKT residual of the answer is at most `limit`. The residual is then kept in `result`, which
  /// must no longer be changed, and is not computed again.
  bool has_residual_below(double limit, const QpData& data, QpResult& result);

 private:
  /// Fills status, x, slack, multipliers and iterations of `result`, which holds the previous answer without
  /// its residual.
  virtual void do_solve(const QpData& data, QpResult& result) = 0;
  /// Fills objective and KKT residual of `result` from its x, slack and multipliers, withdraws `solved` if
  /// the residual is too large, and sets whether the answer is certified. A back end that passes on the
  /// answers of other solvers, which have filled these members, leaves them as they are.
  virtual void certify(const QpData& data, QpResult& result);
  virtual void do_reset() = 0;
  /// The largest residual with which this answer is certified; its own residual must be known.
  double largest_certified_residual(const QpResult& result) const;

  std::shared_ptr<const QpStructure> structure_;
  QpResult result_;
  std::unique_ptr<KktWorkspace> workspace_;
  double time_limit_ = kInfinity;
};

/// A problem that a controller had, and its answer. The parts belong to the controller and stay valid until
/// its next step.
struct SolvedQp {
  const QpStructure& structure;
  const QpData& data;
  const QpResult& result;
};

/// Makes a solver for a structure: how a controller is given its back end.
using QpSolverFactory = std::function<std::unique_ptr<QpSolver>(std::shared_ptr<const QpStructure>)>;

/// `factory` with this time limit of each problem (QpSolver::set_time_limit()).
QpSolverFactory with_time_limit(QpSolverFactory factory, double seconds);

}  // namespace mpm
