// The active-set method, DAQP and HPIPM on the moves of loops of four sizes: docs/performance.md, "Cost
// against size".

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "base/system/thread_clock.hpp"
#include "bench/perf/daqp_rival.hpp"
#include "bench/perf/hpipm_rival.hpp"
#include "bench/perf/sparse_loop.hpp"
#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

constexpr int kFirst = 20;  // the second step of a disturbance

/// The active-set method in the form of the rivals. Its time includes its checks and its certificate.
class Ours {
 public:
  explicit Ours(const QpStructure& structure)
      : solver_(qp_solver_factory("active-set")(std::make_shared<const QpStructure>(structure))) {}

  double solve(const QpData& data) {
    const double begin = thread_seconds();
    solver_->solve(data);
    return thread_seconds() - begin;
  }
  bool solved() const { return solver_->result().status == QpStatus::solved; }
  const Eigen::VectorXd& x() const { return solver_->result().x; }

 private:
  std::unique_ptr<QpSolver> solver_;
};

/// Has a solver solve all programs in their order, from its last answer. Prints one line of the table.
template <class Solver>
void race(const std::string& name, const PlantSize& size, const SparseLoop::Programs& programs) {
  Solver solver(programs.structure);
  std::vector<double> milliseconds;
  double difference = 0.0;
  int not_solved = 0;
  for (std::size_t k = 0; k < programs.data.size(); ++k) {
    milliseconds.push_back(1e3 * solver.solve(programs.data[k]));
    difference = std::max(difference, (solver.x() - programs.answers[k]).cwiseAbs().maxCoeff());
    not_solved += solver.solved() ? 0 : 1;
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  fmt::print("| {} | {} | {:.3g} | {:.3g} | {:.3g} | {:.0e} | {} |\n", size.name(), name,
             sorted_quantile(milliseconds, 0.5), sorted_quantile(milliseconds, 0.99), milliseconds.back(),
             difference, not_solved);
  std::fflush(stdout);
}

void run(int count) {
  fmt::print(
      "Kernels: {}. {} programs of each size.\n\n"
      "| plant | solver | median, ms | p99, ms | max, ms | largest difference of a move | not solved |\n"
      "|---|---|---:|---:|---:|---:|---:|\n",
      lane_kernels().name, count);
  for (const PlantSize& size : kPlantSizes) {
    const SparseLoop::Programs programs = SparseLoop(size, SlackForm::per_sample).programs(kFirst, count);
    race<Ours>("active-set", size, programs);
    race<DaqpRival>("DAQP", size, programs);
    race<HpipmRival>("HPIPM", size, programs);
  }
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  const int count = argc == 2 ? std::atoi(argv[1]) : 0;
  if (count < 1) {
    std::fprintf(stderr, "usage: mpmbench_size_race PROGRAMS (of each size; 40 take some minutes)\n");
    return 2;
  }
  try {
    mpm::run(count);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mpmbench_size_race: %s\n", error.what());
    return 2;
  }
  return 0;
}
