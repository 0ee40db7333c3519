#pragma once

#include <memory>

#include "solvers/qp_solver.hpp"

namespace mpm {

struct IpoptOptions {
  /// Convergence tolerance of Ipopt (its `tol`, and the absolute ones for feasibility and complementarity).
  double tolerance = 1e-10;
  int iteration_limit = 300;
  /// Whether to solve over a working set of row limits, which grows until no left-out limit is violated; the
  /// answer is that of the full problem (see WorkingSet). Otherwise Ipopt gets every limit at once.
  bool working_set = true;
  /// A limit nearer than this to the last answer enters the working set too: it saves rounds, and changes
  /// the answer only within the tolerance.
  double working_set_margin = 0.01;
  /// A problem with at most this many rows is always handed over at once: one run of Ipopt over few
  /// rows is faster than two.
  int rows_at_once = 32;

  /// Throws InputError when a number is out of range.
  void validate() const;
};

/// Ipopt, a primal-dual interior-point method (Waechter & Biegler, Math. Program. 106 (2006) 25-57), with
/// MUMPS.
///
/// Ipopt sees the problem as ReducedProgram writes it.
///
/// An answer `infeasible` is certified: the smallest possible largest violation of the hard row limits within
/// the box, itself found as a linear program, is above 1e-7. If the working set gives no answer, all limits
/// are tried at once. A run that Ipopt ends as a failure counts as solved if its point passes kkt_residual()
/// with at most 1e-7.
///
/// The time limit of a problem (set_time_limit()) is processor time of the thread, checked between
/// iterations. Throws std::bad_alloc when Ipopt has no memory.
///
/// Ipopt with sequential MUMPS must not run in two threads of one process.
class IpoptSolver final : public QpSolver {
 public:
  /// Throws InputError when the structure or an option is not valid.
  IpoptSolver(std::shared_ptr<const QpStructure> structure, const IpoptOptions& options);
  ~IpoptSolver() override;

 private:
  class Implementation;

  void do_solve(const QpData& data, QpResult& result) override;
  void do_reset() override;
  void solve_growing(const QpData& data, QpResult& result);
  void solve_full(const QpData& data, QpResult& result);
  void run(const QpData& data, QpResult& result);
  bool certainly_infeasible(const QpData& data);

  IpoptOptions options_;
  double end_ = 0.0;  ///< of the time for the problem, on the clock thread_seconds()
  std::unique_ptr<Implementation> implementation_;
  std::unique_ptr<IpoptSolver> feasibility_;  ///< made when first needed
};

}  // namespace mpm
