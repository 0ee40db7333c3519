#include <string_view>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "base/error.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/perf/benchmarks.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

// The time of this process and of those that it has waited for: the experiments run in a worker process.
double processor_seconds() {
  double seconds = 0.0;
  for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(whose, &usage);
    for (const timeval& part : {usage.ru_utime, usage.ru_stime})
      seconds += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  }
  return seconds;
}

void add_sensitivity(const Study& study) {
  for (const char* back_end : {"active-set", "ipopt"}) {
    const auto run = [&study, factory = qp_solver_factory(back_end)](benchmark::State& state) {
      const OperatingPoint point = operating_point(study, factory);
      for ([[maybe_unused]] const auto pass : state)
        benchmark::DoNotOptimize(nominal_sensitivity(study, point, factory));
    };
    auto* entry = benchmark::RegisterBenchmark(fmt::format("sensitivity/{}", back_end).c_str(), run)
                      ->Unit(benchmark::kMillisecond);
    if (std::string_view(back_end) == "ipopt")
      entry->Iterations(1);
  }
}

void add_diagnosis(const Study& study) {
  const auto run = [&study](benchmark::State& state) {
    const BasisCase basis = run_basis_case(study, qp_solver_factory("active-set"));
    const Trajectory& loop = basis.trajectory;
    DiagnosisChain chain(study);
    for ([[maybe_unused]] const auto pass : state) {
      const Eigen::MatrixXd y_sim =
          simulated_output(study.plant.G, study.controller.sample_time, basis.point.u, loop.u, loop.d);
      benchmark::DoNotOptimize(chain.diagnose(loop.y, nominal_outputs(basis.sensitivity, loop.y, y_sim)));
    }
  };
  benchmark::RegisterBenchmark("diagnosis", run)->Unit(benchmark::kMillisecond);
}

void add_study(const Study& study, std::int64_t experiments) {
  const auto run = [&study, experiments](benchmark::State& state) {
    RunOptions options;
    options.experiments = experiments;
    options.solver = "active-set";
    options.store = StorePolicy::none;
    for ([[maybe_unused]] const auto pass : state) {
      const double begin = processor_seconds();
      benchmark::DoNotOptimize(run_campaign(study, options));
      state.SetIterationTime(processor_seconds() - begin);
    }
    state.counters["experiments"] = static_cast<double>(experiments);
  };
  benchmark::RegisterBenchmark(fmt::format("study/{}", experiments).c_str(), run)
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kSecond);
}

}  // namespace

void register_study_benchmarks(const Study& study, std::int64_t experiments) {
  if (experiments < 1 || experiments > study.experiment_count())
    throw InputError("experiments", fmt::to_string(experiments),
                     fmt::format("1 to {}", study.experiment_count()));
  add_sensitivity(study);
  add_diagnosis(study);
  add_study(study, experiments);
}

}  // namespace mpm
