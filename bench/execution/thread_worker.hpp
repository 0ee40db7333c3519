#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "solvers/certified_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {

/// The worker of one thread. Ipopt may run in only one thread of a process, so a thread has the active-set
/// method. If there are worker processes with Ipopt (`leaves`), the thread leaves them a whole loop as soon
/// as any problem needs Ipopt: a problem of the loop itself, of the loops that its truth asks for, or of the
/// loops that a method simulates.
template <class Worker>
class ThreadWorker {
 public:
  using Make = std::function<std::unique_ptr<Worker>(const QpSolverFactory&)>;

  ThreadWorker(Make make, bool leaves) : make_(std::move(make)), leaves_(leaves) { make_worker(); }
  ThreadWorker(const ThreadWorker&) = delete;
  ThreadWorker& operator=(const ThreadWorker&) = delete;

  /// Returns what run(worker) returns; none if a process has to run the loop.
  template <class Run>
  auto run(Run run) -> std::optional<decltype(run(std::declval<Worker&>()))> {
    if (worker_ == nullptr)
      make_worker();
    if (left_ > 0)  // the worker needed Ipopt when it was made
      return std::nullopt;
    auto result = run(*worker_);
    if (left_ == 0)
      return result;
    worker_.reset();  // it may have learnt from this loop and would use that for others of its world
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
