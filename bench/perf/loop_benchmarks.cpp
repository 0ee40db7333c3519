#include <memory>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "analysis/study_files/study_library.hpp"
#include "base/system/thread_clock.hpp"
#include "bench/perf/benchmarks.hpp"
#include "bench/perf/timed_plant.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/nonlinear_plant.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

void count(benchmark::State& state, const Trajectory& loop) {
  state.counters["samples"] = static_cast<double>(loop.samples_done);
  state.counters["kkt"] = loop.solver.largest_kkt_residual;
  state.counters["fallbacks"] = static_cast<double>(loop.solver.fallbacks);
}

/// The loop of one experiment.
void add_loop(const std::string& name, std::shared_ptr<const Study> study, const ExperimentDraw& draw,
              const std::string& back_end) {
  const auto run = [study = std::move(study), draw,
                    factory = qp_solver_factory(back_end)](benchmark::State& state) {
    Trajectory loop;
    for ([[maybe_unused]] const auto pass : state)
      loop = simulate_experiment(*study, draw, factory);
    count(state, loop);
  };
  auto* entry = benchmark::RegisterBenchmark(fmt::format("{}/{}", name, back_end).c_str(), run)
                    ->Unit(benchmark::kMillisecond);
  if (back_end == "ipopt")
    entry->Iterations(1);
}

std::shared_ptr<const Study> shipped(const std::string& name) {
  return std::make_shared<const Study>(find_study(name));
}

/// Times the steps of the plant within the basis loop.
void run_tank(benchmark::State& state, const Study& study, Plant& plant) {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const ExperimentDraw draw = basis_draw();
  const LoopSignals signals{measured_disturbances(study), measurement_noise(study, draw.index),
                            unmeasured_disturbances(study, draw), setpoints(study)};
  TimedPlant timed(plant);
  Trajectory loop;
  const double begin = thread_seconds();
  for ([[maybe_unused]] const auto pass : state)
    loop = run_closed_loop(study, timed, signals, factory);
  const double all = thread_seconds() - begin;
  count(state, loop);
  state.counters["plant_share"] = timed.seconds() / all;
  state.counters["controller_share"] = 1.0 - timed.seconds() / all;
}

void add_tank_loops() {
  const std::shared_ptr<const Study> study = shipped("chapter5-tank");
  const auto nonlinear = [study](benchmark::State& state) {
    const std::unique_ptr<Plant> plant = nonlinear_plant(
        study->nonlinear->model, study->controller.sample_time, study->nonlinear->integration, {});
    run_tank(state, *study, *plant);
  };
  const auto linear = [study](benchmark::State& state) {
    LinearPlant plant(study->plant.G, study->controller.sample_time);
    run_tank(state, *study, plant);
  };
  benchmark::RegisterBenchmark("tank/nonlinear", nonlinear)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("tank/linear", linear)->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_loop_benchmarks(const Study& study) {
  const auto recorded = std::make_shared<const Study>(study);
  const std::shared_ptr<const Study> setpoint = shipped("chapter4-shell");
  for (const char* back_end : {"active-set", "ipopt"}) {
    for (const char* loop : {"quiet", "mpm", "ud"})
      add_loop(fmt::format("loop/{}", loop), recorded, recorded_draw(study, loop), back_end);
    add_loop("loop/setpoint", setpoint, draw_experiment(*setpoint, 1), back_end);
  }
  for (const StudyEntry& entry : shipped_studies())
    add_loop("basis/" + entry.name, shipped(entry.name), basis_draw(), "auto");
  add_tank_loops();
}

}  // namespace mpm
