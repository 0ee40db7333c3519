#include "solvers/certified_solver.hpp"

#include <utility>

#include "solvers/ipopt_solver.hpp"

namespace mpm {

bool is_certified(const QpResult& result) {
  return result.status == QpStatus::infeasible || result.certified;
}

CertifiedSolver::CertifiedSolver(std::shared_ptr<const QpStructure> structure, std::int64_t* left_to_others)
    : QpSolver(structure),
      shared_structure_(structure),
      active_set_(std::move(structure), {}),
      left_to_others_(left_to_others) {}

CertifiedSolver::~CertifiedSolver() = default;

void CertifiedSolver::do_reset() {
  active_set_.reset();
}

void CertifiedSolver::do_solve(const QpData& data, QpResult& result) {
  result = active_set_.solve(data);
  if (is_certified(result))
    return;
  if (left_to_others_ != nullptr) {
    ++*left_to_others_;
    return;
  }
  if (!ipopt_)
    ipopt_ = std::make_unique<IpoptSolver>(shared_structure_, IpoptOptions{});
  ipopt_->set_time_limit(time_limit());
  ipopt_->reset();  // the answer must not depend on which problem needed it before
  const int iterations = result.iterations;
  result = ipopt_->solve(data);
  result.iterations += iterations;
  result.from_ipopt = true;
}

}  // namespace mpm
