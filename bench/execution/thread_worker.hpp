#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "solvers/certified_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {

/// The worker of one thread. Ipopt may run in one thread of a process only, so that a thread has the
/// active-set method. With worker processes that have Ipopt (`leaves`) it leaves them a loop as a whole when
/// any problem needs Ipopt: one of the loop itself, of those that its truth asks for, or of those that a
/// method simulates.
template <class Worker>
class ThreadWorker {
 public:
  using Make = std::function<std::unique_ptr<Worker>(const QpSolverFactory&)>;

  ThreadWorker(Make make, bool leaves) : make_(std::move(make)), leaves_(leaves) { make_worker(); }
  ThreadWorker(const ThreadWorker&) = delete;
  ThreadWorker& operator=(const ThreadWorker&) = delete;

  /// What run(worker) returns; none: a process has to run it.
  template <class Run>
  auto run(Run run) -> std::optional<decltype(run(std::declval<Worker&>()))> {
    if (worker_ == nullptr)
      make_worker();
    if (left_ > 0)  // what it has learnt from needs Ipopt
      return std::nullopt;
    auto result = run(*worker_);
    if (left_ == 0)
      return result;
    worker_.reset();  // it may have learnt from this loop what it keeps for others of its world
    return std::nullopt;
  }

 private:
  void make_worker() {
    left_ = 0;
    QpSolverFactory factory = qp_solver_factory("active-set");
    if (leaves_)
      factory = [this](std::shared_ptr<const QpStructure> structure) {
        return std::make_unique<CertifiedSolver>(std::move(structure), &left_);
      };
    worker_ = make_(factory);
  }

  Make make_;
  bool leaves_;
  std::int64_t left_ = 0;
  std::unique_ptr<Worker> worker_;
};

}  // namespace mpm
