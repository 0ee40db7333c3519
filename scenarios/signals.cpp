#include "scenarios/signals.hpp"

#include <algorithm>
#include <cmath>

#include "plants/linear_plant.hpp"
#include "scenarios/random_stream.hpp"

namespace mpm {
namespace {

RandomStream stream_of(const Study& study, std::int64_t index, StreamId id) {
  // The basis index -1 becomes the largest unsigned one, which no experiment reaches.
  return {study.seed, static_cast<std::uint64_t>(index), id};
}

void add_steps(const std::vector<SignalStep>& steps, Eigen::MatrixXd& signal) {
  for (const SignalStep& step : steps)
    signal.row(step.variable).tail(signal.cols() - step.sample).setConstant(step.level);
}

void add_random_steps(const Study& study, Eigen::MatrixXd& d) {
  RandomStream stream = stream_of(study, kBasisIndex, StreamId::excitation);
  for (Eigen::Index md = 0; md < d.rows(); ++md) {
    for (double next = 0.0;;) {
      next += std::max(1.0, study.simulation.step_interval.sample(stream));
      const double level = study.simulation.step_level.sample(stream);
      if (!(next < static_cast<double>(d.cols())))
        break;
      const auto from = static_cast<Eigen::Index>(next);
      d.row(md).tail(d.cols() - from).setConstant(level);
    }
  }
}

}  // namespace

Eigen::MatrixXd measured_disturbances(const Study& study) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(study.md_count(), study.simulation.samples);
  if (study.simulation.random_steps)
    add_random_steps(study, d);
  add_steps(study.simulation.steps, d);
  return d;
}

Eigen::MatrixXd setpoints(const Study& study) {
  if (!study.controller.has_setpoints())
    return {};
  Eigen::MatrixXd y_set = study.simulation.initial_setpoint.replicate(1, study.simulation.samples);
  add_steps(study.simulation.setpoint_steps, y_set);
  return y_set;
}

Eigen::MatrixXd measurement_noise(const Study& study, std::int64_t index) {
  RandomStream stream = stream_of(study, index, StreamId::measurement_noise);
  Eigen::MatrixXd noise(study.cv_count(), study.simulation.samples);
  for (Eigen::Index k = 0; k < noise.cols(); ++k)
    for (Eigen::Index cv = 0; cv < noise.rows(); ++cv)
      noise(cv, k) = study.simulation.noise_standard_deviation(cv) * stream.normal();
  return noise;
}

Eigen::MatrixXd unmeasured_disturbances(const Study& study, const ExperimentDraw& draw) {
  Eigen::MatrixXd signal = Eigen::MatrixXd::Zero(study.cv_count(), study.simulation.samples);
  if (!draw.disturbance)
    return signal;
  RandomStream stream = stream_of(study, draw.index, StreamId::disturbance_signal);
  Eigen::MatrixXd v(1, study.simulation.samples);
  for (Eigen::Index k = 0; k < v.cols(); ++k)
    v(0, k) = study.disturbance.v_standard_deviation * stream.normal();
  const TransferMatrix filter{
      {TransferFunction::first_order(draw.disturbance->gain, draw.disturbance->time_constant)}};
  signal.row(draw.disturbance->cv) = simulate(filter, study.controller.sample_time, v);
  return signal;
}

}  // namespace mpm
