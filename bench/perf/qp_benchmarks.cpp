#include <memory>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/perf/benchmarks.hpp"
#include "bench/perf/qp_timing.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

// Passes over a sequence: enough for a median where that is cheap.
struct BackEndEffort {
  const char* name;
  int passes_all;     // over a whole loop; 0: too slow for it
  int passes_paired;  // over the samples for every back end
};

constexpr BackEndEffort kEfforts[] = {{"active-set", 25, 25}, {"ipopt", 1, 3}, {"ipopt-full", 0, 1}};

void report(benchmark::State& state, const QpTimes& times, std::size_t count) {
  state.counters["median_us"] = times.median;
  state.counters["p99_us"] = times.p99;
  state.counters["max_us"] = times.max;
  state.counters["kkt"] = times.kkt_residual;
  state.counters["iterations"] = times.iterations;
  state.counters["not_solved"] = static_cast<double>(times.not_solved);
  state.counters["infeasible"] = static_cast<double>(times.infeasible);
  state.counters["programs"] = static_cast<double>(count);
}

void add(const std::string& name, const std::shared_ptr<const QpSequence>& sequence, const char* back_end,
         StartOfSolve start, int passes) {
  const auto run = [sequence, factory = qp_solver_factory(back_end), start](benchmark::State& state) {
    QpTiming timing(*sequence, factory, start);
    for ([[maybe_unused]] const auto pass : state)
      state.SetIterationTime(timing.pass());
    report(state, timing.times(), sequence->data.size());
  };
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Iterations(passes)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_qp_benchmarks(const std::vector<QpSequence>& sequences) {
  for (const QpSequence& sequence : sequences) {
    const auto all = std::make_shared<const QpSequence>(sequence);
    const auto paired = std::make_shared<const QpSequence>(sequence.part(kPairedFirst, kPairedCount));
    for (const BackEndEffort& effort : kEfforts)
      for (const StartOfSolve start : {StartOfSolve::warm, StartOfSolve::cold}) {
        const char* start_name = start == StartOfSolve::warm ? "warm" : "cold";
        const auto name = [&](const char* samples) {
          return fmt::format("qp/{}/{}/{}/{}", sequence.name(), samples, effort.name, start_name);
        };
        if (effort.passes_all > 0)
          add(name("all"), all, effort.name, start, effort.passes_all);
        add(name(fmt::to_string(kPairedCount).c_str()), paired, effort.name, start, effort.passes_paired);
      }
  }
}

}  // namespace mpm
