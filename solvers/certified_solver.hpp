#pragma once

#include <cstdint>
#include <memory>

#include "solvers/active_set_solver.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

class IpoptSolver;

/// True for an answer of the active-set method that needs no second solver: certified, or infeasible, which
/// the method returns only with a proof.
bool is_certified(const QpResult& result);

/// The active-set method, with Ipopt for the problems to which it gives no certified answer; the answers of
/// Ipopt are marked `from_ipopt`. Because of Ipopt, the rule of IpoptSolver holds here too: only one thread
/// of a process may use it. Where Ipopt cannot run, such problems are counted, so that another process can
/// solve them: up to the first of them the answers are the same, bit for bit.
class CertifiedSolver final : public QpSolver {
 public:
  /// For each problem that needs Ipopt, asks it or, if `left_to_others` is given, adds 1 to that number,
  /// which must outlive this object. Throws InputError when the structure is not valid.
  explicit CertifiedSolver(std::shared_ptr<const QpStructure> structure,
                           std::int64_t* left_to_others = nullptr);
  ~CertifiedSolver() override;

 private:
  void do_solve(const QpData& data, QpResult& result) override;
  void certify(const QpData&, QpResult&) override {}  // each of the two solvers has done it
  void do_reset() override;

  std::shared_ptr<const QpStructure> shared_structure_;
  ActiveSetSolver active_set_;
  std::int64_t* left_to_others_;
  std::unique_ptr<IpoptSolver> ipopt_;  ///< made when first needed
};

}  // namespace mpm
