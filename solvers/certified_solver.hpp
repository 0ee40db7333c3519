#pragma once

#include <memory>

#include "solvers/active_set_solver.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

class IpoptSolver;

/// Whether an answer of the active-set method stands: certified, or infeasible, which that method says only
/// with a proof.
bool is_certified(const QpResult& result);

/// The active-set method, and Ipopt for the problems to which it gives no certified answer; these are marked
/// `from_ipopt`. It is Ipopt that makes the rule of IpoptSolver hold here too: one thread of a process
/// only. ActiveSetSolver alone gives the same answers, bit for bit, up to the first that is not certified.
class CertifiedSolver final : public QpSolver {
 public:
  /// Throws InputError when the structure is not valid.
  explicit CertifiedSolver(std::shared_ptr<const QpStructure> structure);
  ~CertifiedSolver() override;

 private:
  void do_solve(const QpData& data, QpResult& result) override;
  void certify(const QpData&, QpResult&) override {}  // each of the two solvers has done it
  void do_reset() override;

  std::shared_ptr<const QpStructure> shared_structure_;
  ActiveSetSolver active_set_;
  std::unique_ptr<IpoptSolver> ipopt_;  ///< made when first needed
};

}  // namespace mpm
