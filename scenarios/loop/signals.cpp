#include "scenarios/loop/signals.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

void add_steps(const std::vector<SignalStep>& steps, Eigen::MatrixXd& signal) {
  for (const SignalStep& step : steps)
    signal.row(step.variable)
        .tail(std::max<Eigen::Index>(0, signal.cols() - step.sample))
        .setConstant(step.level);
}

void add_random_steps(const Study& study, std::int64_t index, Eigen::MatrixXd& d) {
  RandomStream stream = experiment_stream(study, index, StreamId::excitation);
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

void add_md_noise(const Study& study, std::int64_t index, Eigen::MatrixXd& d) {
  const double tau = study.simulation.md_noise_time_constant;
  const double phi = tau > 0.0 ? std::exp(-study.controller.sample_time / tau) : 0.0;
  const double innovation = std::sqrt(1.0 - phi * phi);
  RandomStream stream = experiment_stream(study, index, StreamId::md_noise);
  Eigen::VectorXd v(d.rows());
  for (Eigen::Index k = 0; k < d.cols(); ++k)
    for (Eigen::Index md = 0; md < d.rows(); ++md) {
      const double white = stream.normal();
      v(md) = k == 0 ? white : phi * v(md) + innovation * white;
      d(md, k) += study.simulation.md_noise_standard_deviation(md) * v(md);
    }
}

/// A quantile of Student's t with 4 degrees of freedom over its standard deviation sqrt(2) (Shaw 2006,
/// "Sampling Student's t distribution", J. Comput. Finance 9(4), 37-73).
double student_quantile(double p) {
  const double a = 4.0 * p * (1.0 - p);
  const double q = std::cos(std::acos(std::sqrt(a)) / 3.0) / std::sqrt(a);
  return std::copysign(std::numbers::sqrt2 * std::sqrt(std::max(0.0, q - 1.0)), p - 0.5);
}

/// A quantile of the Laplace distribution with variance 1, whose scale is 1/sqrt(2).
double laplace_quantile(double p) {
  return std::copysign(std::log(2.0 * std::min(p, 1.0 - p)) / std::numbers::sqrt2, p - 0.5);
}

/// An innovation with variance 1. Each distribution takes one value of the stream, at the same quantile.
double innovation(NoiseDistribution distribution, RandomStream& stream) {
  if (distribution == NoiseDistribution::normal)
    return stream.normal();
  const double p = stream.uniform() + 0x1p-54;  // midpoints, as those of RandomStream::normal(): never 0
  return distribution == NoiseDistribution::student ? student_quantile(p) : laplace_quantile(p);
}

/// What the values of a signal depend on, besides its form.
struct SignalSetting {
  double standard_deviation, sample_time;
  Eigen::Index samples;
  RandomStream white;
};

Eigen::RowVectorXd values(const WhiteNoise& noise, SignalSetting at) {
  Eigen::RowVectorXd v(at.samples);
  for (Eigen::Index k = 0; k < v.size(); ++k)
    v(k) = k % noise.hold == 0 ? noise.factor * at.standard_deviation * at.white.normal() : v(k - 1);
  return v;
}

Eigen::RowVectorXd values(const Sine& sine, const SignalSetting& at) {
  const double step = 2.0 * std::numbers::pi * at.sample_time / sine.period;
  return sine.amplitude *
         (step * Eigen::RowVectorXd::LinSpaced(at.samples, 0.0, static_cast<double>(at.samples - 1)))
             .array()
             .sin()
             .matrix();
}

Eigen::RowVectorXd values(const Ramp& ramp, const SignalSetting& at) {
  Eigen::RowVectorXd v(at.samples);
  for (Eigen::Index k = 0; k < v.size(); ++k)
    v(k) = ramp.slope * std::max(0.0, static_cast<double>(k) * at.sample_time - ramp.start);
  return v;
}

Eigen::RowVectorXd values(const StepSequence& sequence, const SignalSetting& at) {
  Eigen::RowVectorXd v = Eigen::RowVectorXd::Zero(at.samples);
  for (const StepSequence::Step& step : sequence.steps)
    v.tail(at.samples - step.sample).setConstant(step.level);
  return v;
}

Eigen::RowVectorXd values(const RandomWalk& walk, SignalSetting at) {
  Eigen::RowVectorXd v = Eigen::RowVectorXd::Zero(at.samples);
  for (Eigen::Index k = 1; k < v.size(); ++k)
    v(k) = v(k - 1) + walk.factor * at.standard_deviation * at.white.normal();
  return v;
}

Eigen::RowVectorXd values(const Bursts& bursts, SignalSetting at) {
  Eigen::RowVectorXd v = Eigen::RowVectorXd::Zero(at.samples);
  bool on = false;
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    const double noise = at.white.normal();
    if (on)
      v(k) = bursts.factor * at.standard_deviation * noise;
    if (at.white.uniform() < 1.0 / (on ? bursts.length : bursts.pause))
      on = !on;
  }
  return v;
}

TransferFunction model_of(const Disturbance& disturbance) {
  assert(disturbance.model == DisturbanceModel::first_order || disturbance.Gd);
  return disturbance.model == DisturbanceModel::first_order
             ? TransferFunction::first_order(disturbance.gain, disturbance.time_constant)
             : *disturbance.Gd;
}

Eigen::RowVectorXd through_model(const Disturbance& disturbance, double Ts, const Eigen::RowVectorXd& v) {
  if (disturbance.model == DisturbanceModel::direct)
    return v;
  return simulate(TransferMatrix{{model_of(disturbance)}}, Ts, v);
}

/// The same at the times of the rows of a record.
Eigen::RowVectorXd through_model(const Disturbance& disturbance, double Ts, const Eigen::RowVectorXd& v,
                                 const RowTime& rows) {
  if (disturbance.model == DisturbanceModel::direct)
    return rows_of_line(rows, v);
  Eigen::RowVectorXd held(v.size() + 1);  // the last one acts after the last row
  held << v, 0.0;
  const TransferFunction Gd = model_of(disturbance).with_dead_time_shifted(rows.delay() * Ts);
  return rows_of(rows, simulate(TransferMatrix{{Gd}}, Ts, held, rows.sampling), v.size());
}

/// A stream of its own for each disturbance of a scenario, so that no signal depends on the others.
StreamId disturbance_stream(std::size_t number) {
  constexpr auto kFurther = static_cast<std::uint32_t>(StreamId::further_disturbance_signals);
  return number == 0 ? StreamId::disturbance_signal
                     : static_cast<StreamId>(kFurther + static_cast<std::uint32_t>(number - 1));
}

Eigen::RowVectorXd signal_values(const Study& study, std::int64_t index, std::size_t number,
                                 const DisturbanceSignal& signal) {
  const std::int64_t whose = study.disturbance.sequence == SignalSequence::shared ? kSharedIndex : index;
  return disturbance_signal(signal, study.disturbance.v_standard_deviation, study.controller.sample_time,
                            study.simulation.samples,
                            experiment_stream(study, whose, disturbance_stream(number)));
}

void begin_at(const Onset& onset, Eigen::Ref<Eigen::RowVectorXd> signal) {
  if (onset.from_the_start())
    return;
  for (Eigen::Index k = 0; k < signal.size(); ++k)
    signal(k) *= onset.share(k);
}

/// v of disturbance `number` of the experiment.
Eigen::RowVectorXd driving_values(const Study& study, const ExperimentDraw& draw, std::size_t number) {
  const std::size_t whose = draw.disturbances[number].shares_signal ? 0 : number;
  Eigen::RowVectorXd v = signal_values(study, draw.index, whose, draw.disturbances[whose].signal);
  begin_at(draw.onset, v);
  return v;
}

/// y_d of disturbance `number` of the experiment.
Eigen::RowVectorXd values(const Study& study, const ExperimentDraw& draw, std::size_t number) {
  return through_model(draw.disturbances[number], study.controller.sample_time,
                       driving_values(study, draw, number));
}

/// The sum of the disturbances of each row. `place` gives the row of a disturbance; none if it acts
/// elsewhere.
template <class Place>
Eigen::MatrixXd sum_of_disturbances(const Study& study, const ExperimentDraw& draw, Eigen::Index rows,
                                    Place place) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, study.simulation.samples);
  for (std::size_t i = 0; i < draw.disturbances.size(); ++i)
    if (const std::optional<Eigen::Index> row = place(draw.disturbances[i]))
      sum.row(*row) += values(study, draw, i);
  return sum;
}

}  // namespace

RandomStream experiment_stream(const Study& study, std::int64_t index, StreamId id) {
  // The basis index -1 becomes the largest unsigned one, which no experiment reaches.
  return {study.seed, static_cast<std::uint64_t>(index), id};
}

Eigen::MatrixXd measured_disturbances(const Study& study, std::int64_t index) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(study.md_count(), study.simulation.samples);
  if (study.simulation.random_steps)
    add_random_steps(study, index, d);
  add_steps(study.simulation.steps, d);
  if (study.simulation.md_noise_standard_deviation.size() > 0)
    add_md_noise(study, index, d);
  return d;
}

Eigen::MatrixXd dither(const Study& study) {
  if (study.simulation.dither.empty())
    return {};
  // A designed signal, not a random one of the study: every study has that of seed 0.
  RandomStream stream(0, static_cast<std::uint64_t>(kBasisIndex), StreamId::dither);
  Eigen::MatrixXd added = Eigen::MatrixXd::Zero(study.mv_count(), study.simulation.samples);
  for (const Dither& signal : study.simulation.dither)
    for (Eigen::Index k = 0; k < added.cols(); ++k)
      added(signal.mv, k) = k % signal.hold != 0   ? added(signal.mv, k - 1)
                            : stream.below(2) == 0 ? -signal.amplitude
                                                   : signal.amplitude;
  return added;
}

Limits soft_limits(const Study& study, Eigen::Index k) {
  Limits limits = study.controller.cv_soft;
  for (const LimitStep& step : study.simulation.limit_steps) {
    if (step.sample > k)
      break;
    limits.lower(step.cv) = step.lower;
    limits.upper(step.cv) = step.upper;
  }
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (is_off(study, VariableSort::cv, cv, k)) {
      limits.lower(cv) = -kInfinity;
      limits.upper(cv) = kInfinity;
    }
  return limits;
}

Eigen::MatrixXd setpoints(const Study& study) {
  if (!study.controller.has_setpoints())
    return {};
  Eigen::MatrixXd y_set = study.simulation.initial_setpoint.replicate(1, study.simulation.samples);
  add_steps(study.simulation.setpoint_steps, y_set);
  return y_set;
}

Eigen::MatrixXd measurement_noise(const Study& study, std::int64_t index) {
  const SimulationOptions& simulation = study.simulation;
  const double phi = simulation.noise.autocorrelation;
  const bool is_shared = simulation.noise.sequence == SignalSequence::shared && index != kRepeatIndex;
  RandomStream stream =
      experiment_stream(study, is_shared ? kSharedIndex : index, StreamId::measurement_noise);
  Eigen::MatrixXd noise(study.cv_count(), simulation.samples);
  for (Eigen::Index k = 0; k < noise.cols(); ++k)
    for (Eigen::Index cv = 0; cv < noise.rows(); ++cv)
      noise(cv, k) = innovation(simulation.noise.distribution, stream);
  for (Eigen::Index k = 1; k < noise.cols() && phi != 0.0; ++k)
    noise.col(k) = phi * noise.col(k - 1) + std::sqrt(1.0 - phi * phi) * noise.col(k);
  return simulation.noise_standard_deviation.asDiagonal() * noise;
}

Eigen::RowVectorXd disturbance_signal(const DisturbanceSignal& signal, double standard_deviation,
                                      double sample_time, Eigen::Index samples, RandomStream white) {
  return std::visit(
      [&](const auto& form) -> Eigen::RowVectorXd {
        return values(form, {standard_deviation, sample_time, samples, white});
      },
      signal);
}

Eigen::RowVectorXd disturbance_output(const Study& study, std::int64_t index,
                                      const Disturbance& disturbance) {
  return through_model(disturbance, study.controller.sample_time,
                       signal_values(study, index, 0, disturbance.signal));
}

Eigen::MatrixXd unmeasured_disturbances(const Study& study, const ExperimentDraw& draw) {
  return sum_of_disturbances(study, draw, study.cv_count(), [](const Disturbance& disturbance) {
    return disturbance.is_on_cv() ? std::optional(disturbance.cv) : std::nullopt;
  });
}

Eigen::MatrixXd unmeasured_disturbances_of_rows(const Study& study, const ExperimentDraw& draw) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(study.cv_count(), study.simulation.samples);
  for (std::size_t i = 0; i < draw.disturbances.size(); ++i)
    if (const Disturbance& disturbance = draw.disturbances[i]; disturbance.is_on_cv())
      sum.row(disturbance.cv) +=
          through_model(disturbance, study.controller.sample_time, driving_values(study, draw, i),
                        row_time(study.record, VariableSort::cv, disturbance.cv));
  return sum;
}

Eigen::MatrixXd disturbances_of_mvs(const Study& study, const ExperimentDraw& draw) {
  if (std::none_of(draw.disturbances.begin(), draw.disturbances.end(),
                   [](const Disturbance& disturbance) { return disturbance.mv.has_value(); }))
    return {};
  return sum_of_disturbances(study, draw, study.mv_count(),
                             [](const Disturbance& disturbance) { return disturbance.mv; });
}

Eigen::MatrixXd disturbances_within_plant(const Study& study, const ExperimentDraw& draw) {
  if (!study.nonlinear)
    return {};
  return sum_of_disturbances(study, draw,
                             static_cast<Eigen::Index>(study.nonlinear->model.inner_inputs.size()),
                             [](const Disturbance& disturbance) { return disturbance.inner_input; });
}

Eigen::MatrixXd sensor_errors(const Study& study, const ExperimentDraw& draw) {
  const std::optional<OtherFault>& fault = draw.other;
  if (!fault || info_of(fault->kind).effect != FaultEffect::sensor_error)
    return {};
  const Eigen::Index N = study.simulation.samples;
  const Onset onset = info_of(fault->kind).grows_to_end
                          ? Onset{draw.onset.sample, std::max(1, static_cast<int>(N) - 1 - draw.onset.sample)}
                          : draw.onset;
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(study.cv_count(), N);
  for (Eigen::Index k = 0; k < N; ++k)
    errors(fault->variable, k) = onset.share(k) * fault->size;
  return errors;
}

Eigen::MatrixXd measurements_of_mds(const Study& study, const ExperimentDraw& draw) {
  const std::optional<OtherFault>& fault = draw.other;
  if (!fault || info_of(fault->kind).effect != FaultEffect::md_error)
    return {};
  Eigen::MatrixXd d = measured_disturbances(study);
  Eigen::RowVectorXd error = (fault->size - 1.0) * d.row(fault->variable);
  if (!info_of(fault->kind).is_factor) {
    RandomStream stream = experiment_stream(study, draw.index, StreamId::md_measurement);
    for (double& e : error)
      e = fault->size * stream.normal();
  }
  begin_at(draw.onset, error);
  d.row(fault->variable) += error;
  return d;
}

}  // namespace mpm
