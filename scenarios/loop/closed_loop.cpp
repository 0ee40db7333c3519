#include "scenarios/loop/closed_loop.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/changing_plant.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/nonlinear_plant.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/loop/world.hpp"
#include "scenarios/study/study_controller.hpp"

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
  trajectory.y_set = signals.y_set;
  return trajectory;
}

/// Do the soft limits of the study change at this sample?
bool some_limit_moves(const Study& study, Eigen::Index k) {
  const std::vector<LimitStep>& steps = study.simulation.limit_steps;
  return std::any_of(steps.begin(), steps.end(), [k](const LimitStep& step) { return step.sample == k; });
}

void fail(Trajectory& trajectory, LoopFailure failure, std::string message) {
  trajectory.status = ControlStatus::failed;
  trajectory.failure = failure;
  trajectory.message = std::move(message);
}

/// Puts the plant at rest. Whether it can rest there depends on how it differs from the model in this loop:
/// if it cannot, the loop fails.
void begin(Plant& plant, const Eigen::VectorXd& input, Trajectory& trajectory) {
  try {
    plant.reset(input);
  } catch (const NoSteadyState& error) {
    fail(trajectory, LoopFailure::no_steady_state,
         fmt::format("the plant has no steady state to begin at: {}", error.what()));
  }
}

/// What stands between the controller and the plant: a valve, operators, a changed limit.
class Surroundings {
 public:
  Surroundings(const Study& study, const LoopSignals& signals)
      : study_(study),
        faults_(signals.faults),
        u_d_(signals.u_d),
        curvature_(signals.valve_curvature),
        schedule_(study) {}

  /// Takes the MVs at which the loop starts: every valve passes these unchanged.
  void start(const Eigen::Ref<const Eigen::VectorXd>& u) {
    start_offset_ = Eigen::VectorXd::Zero(curvature_.size());
    for (Eigen::Index mv = 0; mv < curvature_.size(); ++mv)
      start_offset_(mv) = bend(mv, u(mv));
  }

  /// Tells the controller, before it decides on sample k, which variables are off and what its soft limits
  /// are, if any of these change. `before` are the MVs that act until then.
  void prepare(Eigen::Index k, const Eigen::Ref<const Eigen::VectorXd>& before, Controller& controller) {
    const bool switches = schedule_.go_on(k, before);
    if (switches)
      controller.set_off(schedule_.off());
    if (!switches && !some_limit_moves(study_, k) && !(faults_.limit && k == faults_.limit->sample))
      return;
    Limits limits = soft_limits(study_, k);
    if (faults_.limit && k >= faults_.limit->sample) {
      limits.lower(faults_.limit->cv) += faults_.limit->shift;
      limits.upper(faults_.limit->cv) += faults_.limit->shift;
    }
    controller.set_cv_soft(limits);
  }

  /// Sets the MVs in `u` that are off to the values at which they are held.
  void hold_off(Eigen::Ref<Eigen::VectorXd> u) const { schedule_.off().hold(u); }

  /// Passes the MVs of sample k to the plant: `u` comes in as the controller asks for it and goes out as the
  /// record shows it; `acting` becomes what the plant gets.
  void pass(Eigen::Index k, const Eigen::Ref<const Eigen::VectorXd>& before, Eigen::Ref<Eigen::VectorXd> u,
            Eigen::Ref<Eigen::VectorXd> acting) {
    if (faults_.hold && k >= faults_.hold->sample)
      u(faults_.hold->mv) = before(faults_.hold->mv);
    acting = u;
    if (faults_.valve && k >= faults_.valve->sample) {
      const LoopFaults::Valve& fault = *faults_.valve;
      if (!valve_)
        valve_ = info_of(fault.fault.kind).stem(fault.fault, before(fault.mv));
      acting(fault.mv) = valve_->follow(u(fault.mv));
    }
    for (Eigen::Index mv = 0; mv < curvature_.size(); ++mv)
      acting(mv) += bend(mv, acting(mv)) - start_offset_(mv);
    if (u_d_.size() > 0)
      acting += u_d_.col(k);
  }

 private:
  /// What the characteristic of the valve adds to the MV.
  double bend(Eigen::Index mv, double u) const {
    const Limits& hard = study_.controller.mv_hard;
    const double a = hard.lower(mv), b = hard.upper(mv);
    return curvature_(mv) * (u - a) * (b - u) / (b - a);
  }

  const Study& study_;
  const LoopFaults& faults_;
  const Eigen::MatrixXd& u_d_;
  const Eigen::VectorXd& curvature_;
  Eigen::VectorXd start_offset_;
  OffSchedule schedule_;
  std::unique_ptr<ValveStem> valve_;
};

/// Collects the rows of the record of one loop, if their times are not those of the samples.
class RowRecorder {
 public:
  /// `plant` gives the outputs at the times of the rows, if `has_rows`.
  RowRecorder(const Study& study, const LoopSignals& signals, const Plant& plant, bool has_rows)
      : study_(study), faults_(signals.faults), added_(signals.y_rows), plant_(plant) {
    if (has_rows && added_.size() > 0) {
      require_shape("disturbances of the rows", added_, study.cv_count(), study.simulation.samples);
      output_.setZero(study.cv_count(), study.simulation.samples + 1);
    }
  }

  /// Keeps the output of sample k; to be called before the plant goes on.
  void note(Eigen::Index k) {
    if (output_.size() > 0)
      output_.col(k) = plant_.output();
  }

  /// Writes the rows into `loop`. The rows of a CV with an analyser are those of the values that it shows.
  void finish(Trajectory& loop) {
    if (output_.size() == 0)
      return;
    const Eigen::Index samples = added_.cols();
    loop.y_sampled.setZero(added_.rows(), samples);
    if (loop.status != ControlStatus::ok)
      return;
    note(samples);
    loop.y_sampled = added_;
    const std::vector<AnalyserTiming>& analysers = study_.controller.analysers;
    for (Eigen::Index cv = 0; cv < added_.rows(); ++cv) {
      const RowTime time = row_time(study_.record, VariableSort::cv, cv);
      if (!analysers.empty() && analysers[static_cast<std::size_t>(cv)].is_analyser())
        loop.y_sampled.row(cv) = rows_of_held(time, loop.y.row(cv));
      else
        loop.y_sampled.row(cv) += rows_of(time, output_.row(cv), samples);
    }
    if (faults_.stuck)
      hold_stuck(loop);
  }

 private:
  /// Sets the rows after the time at which the sensor sticks to the value at which it is stuck.
  void hold_stuck(Trajectory& loop) const {
    const auto [cv, sample] = *faults_.stuck;
    const double shift = row_time(study_.record, VariableSort::cv, cv).shift;
    for (Eigen::Index k = 0; k < loop.y_sampled.cols(); ++k)
      if (static_cast<double>(k) + shift > static_cast<double>(sample))
        loop.y_sampled(cv, k) = loop.y(cv, sample);
  }

  const Study& study_;
  const LoopFaults& faults_;
  const Eigen::MatrixXd& added_;
  const Plant& plant_;
  Eigen::MatrixXd output_;  ///< ny x (N + 1)
};

/// The other fault of the draw as a fault of the loop, from the sample of the onset on.
LoopFaults loop_faults(const ExperimentDraw& draw) {
  LoopFaults faults;
  if (!draw.other)
    return faults;
  const OtherFault& fault = *draw.other;
  const FaultEffect effect = info_of(fault.kind).effect;
  if (effect == FaultEffect::valve)
    faults.valve = {fault.variable, fault, draw.onset.sample};
  if (faults.valve && draw.onset.sample > 0)
    faults.valve->fault.start = 0.0;  // until then it followed its signal
  if (effect == FaultEffect::sensor_stuck)
    faults.stuck = {fault.variable, draw.onset.sample};
  if (effect == FaultEffect::hold)
    faults.hold = {fault.variable, draw.onset.sample};
  if (effect == FaultEffect::limit)
    faults.limit = {fault.variable, fault.size, draw.onset.sample};
  return faults;
}

/// Onset::share(k) over the record.
Eigen::VectorXd shares(const Onset& onset, Eigen::Index samples) {
  Eigen::VectorXd a(samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    a(k) = onset.share(k);
  return a;
}

/// What is added to the outputs of the plant at the times of the rows: the exact responses to disturbances,
/// background and errors of sensors by linear interpolation, and the noise of the sample. Every row has noise
/// of the same size, be it a measurement or a mean.
Eigen::MatrixXd added_to_rows(const Study& study, const ExperimentDraw& draw, const LoopSignals& signals) {
  Eigen::MatrixXd rows = unmeasured_disturbances_of_rows(study, draw);
  const Eigen::MatrixXd lines = signals.y_d - unmeasured_disturbances(study, draw);
  for (Eigen::Index cv = 0; cv < rows.rows(); ++cv) {
    const RowTime time = row_time(study.record, VariableSort::cv, cv);
    rows.row(cv) += rows_of_line(time, lines.row(cv)) + rows_of(time, signals.noise.row(cv), rows.cols());
  }
  return rows;
}

/// The plant with each output delayed by its number of samples.
TransferMatrix delayed(TransferMatrix plant, const Eigen::VectorXd& delay, double sample_time) {
  for (Eigen::Index row = 0; row < delay.size(); ++row)
    for (Eigen::Index col = 0; col < plant.cols() && delay(row) > 0.0; ++col)
      if (!plant(row, col).is_zero())
        plant(row, col) = plant(row, col).with_dead_time_shifted(delay(row) * sample_time);
  return plant;
}

/// The plant of an experiment with outputs that are sampled in this way. `delay` has a fraction of a sample
/// for each CV; it is empty for the outputs that the controller measures.
std::unique_ptr<Plant> plant_as(const Study& study, const ExperimentDraw& draw, OutputSampling sampling,
                                const Eigen::VectorXd& delay) {
  const double Ts = study.controller.sample_time;
  const World world = draw_world(study, draw.world);
  if (study.nonlinear) {
    const NonlinearModel model = with_parameters(study.nonlinear->model, world.parameters);
    const std::vector<ParameterChange> changes = with_world_parameters(study, world, draw.parameters);
    const OdeOptions& options = study.nonlinear->integration;
    return delay.size() > 0
               ? nonlinear_recorder(model, Ts, options, changes, draw.onset.sample, sampling, delay)
               : nonlinear_plant(model, Ts, options, changes, draw.onset.sample);
  }
  const TransferMatrix healthy = world_plant(study, world);
  const TransferMatrix plant = delayed(with_world_mismatches(healthy, draw.mismatches), delay, Ts);
  if (draw.onset.from_the_start() || draw.mismatches.empty())
    return std::make_unique<LinearPlant>(plant, Ts, sampling);
  return std::make_unique<ChangingPlant>(delayed(healthy, delay, Ts), plant, Ts,
                                         shares(draw.onset, study.simulation.samples), sampling);
}

}  // namespace

void SolverStatistics::add(const SolverStatistics& other) {
  steps += other.steps;
  iterations += other.iterations;
  fallbacks += other.fallbacks;
  largest_kkt_residual = std::max(other.largest_kkt_residual, largest_kkt_residual);  // keeps a NaN
}

Trajectory run_closed_loop(const Study& study, Plant& plant, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer, Plant* recorder) {
  require_fit(study, plant);
  const Eigen::Index samples = study.simulation.samples;
  require_shape("measured disturbances", signals.d, study.md_count(), samples);
  require_shape("measurement noise", signals.noise, study.cv_count(), samples);
  require_shape("unmeasured disturbances", signals.y_d, study.cv_count(), samples);
  if (signals.y_set.size() > 0)
    require_shape("setpoints", signals.y_set, study.cv_count(), samples);
  if (signals.dither.size() > 0)
    require_shape("dither", signals.dither, study.mv_count(), samples);

  if (signals.u_d.size() > 0)
    require_shape("disturbances of the MVs", signals.u_d, study.mv_count(), samples);
  if (signals.d_measured.size() > 0)
    require_shape("measurements of the MDs", signals.d_measured, study.md_count(), samples);

  const Eigen::Index inner =
      signals.within_plant.size() > 0 ? plant.input_count() - study.mv_count() - study.md_count() : 0;
  if (signals.within_plant.size() > 0)
    require_shape("disturbances within the plant", signals.within_plant, inner, samples);

  const std::unique_ptr<Controller> own = controller_of(study, study.controller, factory);
  Controller& controller = *own;
  const Eigen::VectorXd d_rest = Eigen::VectorXd::Zero(study.md_count());
  controller.set_setpoints(study.simulation.initial_setpoint);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(plant.input_count());
  input.head(study.mv_count()) = controller.nominal_target(d_rest);
  controller.reset(input.head(study.mv_count()), d_rest);

  Trajectory trajectory = empty_trajectory(study, signals);
  trajectory.d = as_shown(study.controller.md_analysers,
                          signals.d_measured.size() > 0 ? signals.d_measured : signals.d, d_rest);
  Surroundings surroundings(study, signals);
  Eigen::VectorXd u = input.head(study.mv_count());
  Eigen::VectorXd u_before = u;
  surroundings.start(u);
  begin(plant, input, trajectory);
  AnalyserHold analysers(study.controller.analysers);
  if (trajectory.failure == LoopFailure::none)
    analysers.reset(plant.output());
  if (study.controller_program)
    trajectory.solver.largest_kkt_residual = kNaN;
  RowRecorder rows(study, signals, recorder != nullptr ? *recorder : plant,
                   recorder != nullptr || !study.record.looks_between_samples());
  if (recorder != nullptr && trajectory.failure == LoopFailure::none)
    begin(*recorder, input, trajectory);
  for (Eigen::Index k = 0; k < samples && trajectory.failure == LoopFailure::none; ++k) {
    trajectory.y.col(k) = plant.output() + signals.y_d.col(k) + signals.noise.col(k);
    if (const auto& stuck = signals.faults.stuck; stuck && k > stuck->sample)
      trajectory.y(stuck->cv, k) = trajectory.y(stuck->cv, stuck->sample);
    analysers.pass(trajectory.y.col(k));
    if (signals.y_set.size() > 0)
      controller.set_setpoints(signals.y_set.col(k));
    surroundings.prepare(k, u_before, controller);
    const ControlMove& move = controller.step(trajectory.y.col(k), trajectory.d.col(k));
    trajectory.solver.steps += 1;
    trajectory.solver.iterations += move.iterations;
    trajectory.solver.fallbacks += move.fallbacks;
    if (observer)
      observer(controller);
    trajectory.status = move.status;
    if (move.status == ControlStatus::failed)
      fail(trajectory, study.controller_program ? LoopFailure::controller : LoopFailure::solver,
           controller.failure());
    if (move.status != ControlStatus::ok)
      break;
    trajectory.solver.largest_kkt_residual =
        std::max(trajectory.solver.largest_kkt_residual, move.kkt_residual);  // keeps a NaN
    u = move.u;
    if (signals.dither.size() > 0) {
      const Limits& hard = study.controller.mv_hard;
      u = (move.u + signals.dither.col(k)).cwiseMax(hard.lower).cwiseMin(hard.upper);
      surroundings.hold_off(u);
      controller.set_acting(u);
    }
    surroundings.pass(k, u_before, u, input.head(study.mv_count()));
    u_before = u;
    input.segment(study.mv_count(), study.md_count()) = signals.d.col(k);
    if (inner > 0)
      input.tail(inner) = signals.within_plant.col(k);
    rows.note(k);
    if (plant.advance(input) != PlantStatus::ok ||
        (recorder != nullptr && recorder->advance(input) != PlantStatus::ok)) {
      fail(trajectory, LoopFailure::plant, plant.failure());
      break;
    }
    trajectory.u.col(k) = u;
    trajectory.u_target.col(k) = move.u_target;
    trajectory.samples_done = k + 1;
  }
  rows.finish(trajectory);
  return trajectory;
}

Trajectory run_closed_loop(const Study& study, const TransferMatrix& plant_model, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer) {
  LinearPlant plant(plant_model, study.controller.sample_time);
  return run_closed_loop(study, plant, signals, factory, observer);
}

std::unique_ptr<Plant> experiment_plant(const Study& study, const ExperimentDraw& draw) {
  return plant_as(study, draw, OutputSampling::snapshot, {});
}

std::unique_ptr<Plant> record_plant(const Study& study, const ExperimentDraw& draw) {
  if (!study.record.looks_between_samples())
    return nullptr;
  Eigen::VectorXd delay(study.cv_count());
  for (Eigen::Index cv = 0; cv < delay.size(); ++cv)
    delay(cv) = row_time(study.record, VariableSort::cv, cv).delay();
  return plant_as(study, draw, study.record.sampling, delay);
}

LoopSignals experiment_signals(const Study& study, const ExperimentDraw& draw) {
  const World world = draw_world(study, draw.world);
  const std::int64_t noise = draw.noise_index.value_or(draw.index);
  LoopSignals signals{measured_disturbances(study),
                      draw.noise_factor * (world.noise_factor.asDiagonal() * measurement_noise(study, noise)),
                      unmeasured_disturbances(study, draw),
                      setpoints(study),
                      disturbances_within_plant(study, draw),
                      dither(study)};
  signals.u_d = disturbances_of_mvs(study, draw);
  Background always = background(study, world, noise);
  if (always.y_d.size() > 0)
    signals.y_d += always.y_d;
  if (always.u_d.size() > 0 && signals.u_d.size() > 0)
    signals.u_d += always.u_d;
  else if (always.u_d.size() > 0)
    signals.u_d = std::move(always.u_d);
  signals.valve_curvature = world.valve_curvature;
  signals.d_measured = measurements_of_mds(study, draw);
  signals.faults = loop_faults(draw);
  if (const Eigen::MatrixXd errors = sensor_errors(study, draw); errors.size() > 0)
    signals.y_d += errors;
  if (study.record.resamples())
    signals.y_rows = added_to_rows(study, draw, signals);
  return signals;
}

Trajectory simulate_experiment(const Study& study, const ExperimentDraw& draw, const QpSolverFactory& factory,
                               const StepObserver& observer) {
  if (study.simulation.excitation == SignalSequence::each)
    return simulate_experiment(with_excitation(study, draw.index), draw, factory, observer);
  if (draw.tuning) {
    ExperimentDraw rest = draw;
    rest.tuning.reset();
    return simulate_experiment(with_tuning(study, draw), rest, factory, observer);
  }
  const std::unique_ptr<Plant> plant = experiment_plant(study, draw);
  const std::unique_ptr<Plant> recorder = record_plant(study, draw);
  return run_closed_loop(study, *plant, experiment_signals(study, draw), factory, observer, recorder.get());
}

}  // namespace mpm
