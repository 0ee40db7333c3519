#include "scenarios/closed_loop.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/linear_plant.hpp"
#include "scenarios/signals.hpp"

namespace mpm {
namespace {

void require_shape(const char* name, const Eigen::MatrixXd& signal, Eigen::Index rows, Eigen::Index cols) {
  if (signal.rows() != rows || signal.cols() != cols)
    throw InputError(name, fmt::format("{} x {}", signal.rows(), signal.cols()),
                     fmt::format("{} x {}", rows, cols));
}

void require_fit(const Study& study, const Plant& plant) {
  if (plant.sample_time() != study.controller.sample_time)
    throw InputError("sample time of the plant", fmt::to_string(plant.sample_time()),
                     fmt::format("{}, that of the controller", study.controller.sample_time));
  if (plant.output_count() != study.cv_count())
    throw InputError("outputs of the plant", fmt::to_string(plant.output_count()),
                     fmt::to_string(study.cv_count()));
  if (plant.input_count() < study.mv_count() + study.md_count())
    throw InputError("inputs of the plant", fmt::to_string(plant.input_count()),
                     fmt::format("{} or more", study.mv_count() + study.md_count()));
}

Trajectory empty_trajectory(const Study& study, const LoopSignals& signals) {
  Trajectory trajectory;
  const Eigen::Index samples = study.simulation.samples;
  trajectory.y.setZero(study.cv_count(), samples);
  trajectory.u.setZero(study.mv_count(), samples);
  trajectory.u_target.setZero(study.mv_count(), samples);
  trajectory.d = signals.d;
  trajectory.y_set = signals.y_set;
  return trajectory;
}

void fail(Trajectory& trajectory, LoopFailure failure, std::string message) {
  trajectory.status = ControlStatus::failed;
  trajectory.failure = failure;
  trajectory.message = std::move(message);
}

/// Puts the plant at rest. Whether it can rest there depends on what differs from the model in this loop:
/// that is an outcome of the loop.
void begin(Plant& plant, const Eigen::VectorXd& input, Trajectory& trajectory) {
  try {
    plant.reset(input);
  } catch (const NoSteadyState& error) {
    fail(trajectory, LoopFailure::no_steady_state,
         fmt::format("the plant has no steady state to begin at: {}", error.what()));
  }
}

}  // namespace

std::string_view to_string(LoopFailure failure) {
  switch (failure) {
    case LoopFailure::none:
      return "none";
    case LoopFailure::solver:
      return "solver";
    case LoopFailure::plant:
      return "plant";
    case LoopFailure::no_steady_state:
      return "no_steady_state";
  }
  return "unknown";
}

void SolverStatistics::add(const SolverStatistics& other) {
  steps += other.steps;
  iterations += other.iterations;
  fallbacks += other.fallbacks;
  largest_kkt_residual = std::max(largest_kkt_residual, other.largest_kkt_residual);
}

Trajectory run_closed_loop(const Study& study, Plant& plant, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer) {
  require_fit(study, plant);
  const Eigen::Index samples = study.simulation.samples;
  require_shape("measured disturbances", signals.d, study.md_count(), samples);
  require_shape("measurement noise", signals.noise, study.cv_count(), samples);
  require_shape("unmeasured disturbances", signals.y_d, study.cv_count(), samples);
  if (signals.y_set.size() > 0)
    require_shape("setpoints", signals.y_set, study.cv_count(), samples);

  const Eigen::Index within =
      signals.within_plant.size() > 0 ? plant.input_count() - study.mv_count() - study.md_count() : 0;
  if (signals.within_plant.size() > 0)
    require_shape("disturbances within the plant", signals.within_plant, within, samples);

  Mpc controller(study.plant.G, study.mv_count(), study.controller, factory);
  const Eigen::VectorXd d_rest = Eigen::VectorXd::Zero(study.md_count());
  controller.set_setpoints(study.simulation.initial_setpoint);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(plant.input_count());
  input.head(study.mv_count()) = controller.nominal_target(d_rest);
  controller.reset(input.head(study.mv_count()), d_rest);

  Trajectory trajectory = empty_trajectory(study, signals);
  begin(plant, input, trajectory);
  for (Eigen::Index k = 0; k < samples && trajectory.failure == LoopFailure::none; ++k) {
    trajectory.y.col(k) = plant.output() + signals.y_d.col(k) + signals.noise.col(k);
    if (signals.y_set.size() > 0)
      controller.set_setpoints(signals.y_set.col(k));
    const ControlMove& move = controller.step(trajectory.y.col(k), signals.d.col(k));
    trajectory.solver.steps += 1;
    trajectory.solver.iterations += move.iterations;
    trajectory.solver.fallbacks += move.fallbacks;
    if (observer)
      observer(controller);
    trajectory.status = move.status;
    if (move.status == ControlStatus::failed)
      fail(trajectory, LoopFailure::solver, "the solver gave no answer");
    if (move.status != ControlStatus::ok)
      break;
    trajectory.solver.largest_kkt_residual =
        std::max(trajectory.solver.largest_kkt_residual, move.kkt_residual);
    input.head(study.mv_count()) = move.u;
    input.segment(study.mv_count(), study.md_count()) = signals.d.col(k);
    if (within > 0)
      input.tail(within) = signals.within_plant.col(k);
    if (plant.advance(input) != PlantStatus::ok) {
      fail(trajectory, LoopFailure::plant, "the plant could not be integrated");
      break;
    }
    trajectory.u.col(k) = move.u;
    trajectory.u_target.col(k) = move.u_target;
    trajectory.samples_done = k + 1;
  }
  return trajectory;
}

Trajectory run_closed_loop(const Study& study, const TransferMatrix& plant_model, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer) {
  LinearPlant plant(plant_model, study.controller.sample_time);
  return run_closed_loop(study, plant, signals, factory, observer);
}

Trajectory simulate_experiment(const Study& study, const ExperimentDraw& draw, const QpSolverFactory& factory,
                               const StepObserver& observer) {
  if (draw.tuning) {
    ExperimentDraw rest = draw;
    rest.tuning.reset();
    return simulate_experiment(with_tuning(study, draw), rest, factory, observer);
  }
  const LoopSignals signals{measured_disturbances(study), measurement_noise(study, draw.index),
                            unmeasured_disturbances(study, draw), setpoints(study),
                            disturbances_within_plant(study, draw)};
  if (!study.nonlinear)
    return run_closed_loop(study, with_mismatches(study.plant.G, draw.mismatches), signals, factory,
                           observer);
  const std::unique_ptr<Plant> plant = nonlinear_plant(study.nonlinear->model, study.controller.sample_time,
                                                       study.nonlinear->integration, draw.parameters);
  return run_closed_loop(study, *plant, signals, factory, observer);
}

}  // namespace mpm
