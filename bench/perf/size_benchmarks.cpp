#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "bench/perf/benchmarks.hpp"
#include "bench/perf/sparse_loop.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

constexpr int kSamples = 200;

void report_steps(benchmark::State& state, SparseLoop::Times times) {
  std::vector<double>& step = times.step;
  const double all = 1e-6 * std::accumulate(step.begin(), step.end(), 0.0);
  std::sort(step.begin(), step.end());
  state.counters["median_us"] = sorted_quantile(step, 0.5);
  state.counters["p99_us"] = sorted_quantile(step, 0.99);
  state.counters["max_us"] = step.back();
  state.counters["targets_share"] = times.targets / all;
  state.counters["moves_share"] = times.moves / all;
  state.counters["iterations"] = times.iterations;
  state.counters["kkt"] = times.kkt_residual;
  state.counters["not_solved"] = static_cast<double>(times.not_solved);
  state.counters["making_ms"] = 1e3 * times.making;
  state.counters["programs"] = static_cast<double>(step.size());
}

}  // namespace

void register_size_benchmarks() {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  for (const PlantSize& size : kPlantSizes)
    for (const SlackForm slack : {SlackForm::per_sample, SlackForm::per_cv}) {
      const auto run = [size, slack, factory](benchmark::State& state) {
        const SparseLoop loop(size, slack);
        SparseLoop::Times times;
        for ([[maybe_unused]] const auto pass : state)
          times = loop.run(factory, kSamples);
        report_steps(state, std::move(times));
      };
      benchmark::RegisterBenchmark(fmt::format("size/{}/{}", size.name(), to_string(slack)).c_str(), run)
          ->Unit(benchmark::kMillisecond);
    }
}

}  // namespace mpm
