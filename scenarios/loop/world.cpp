#include "scenarios/loop/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "plants/linear/settling_time.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/loop/kind_sequence.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// Draws the errors of one channel. Each error takes one value of the stream, whatever its distribution.
void draw_errors(const WorldRanges& ranges, const TransferFunction& model, Eigen::Index cv,
                 Eigen::Index input, RandomStream& stream, std::vector<Mismatch>& errors) {
  const double gain = ranges.gain_factor.sample(stream);
  const double time_constant = ranges.time_constant_factor.sample(stream);
  const double dead_time =
      ranges.dead_time_factor.sample(stream) * model.dead_time() + ranges.dead_time_shift.sample(stream);
  const double lag = ranges.extra_lag.sample(stream) * sum_of_time_constants(model);
  if (gain != 1.0)
    errors.push_back({cv, input, MismatchParameter::gain, gain});
  if (time_constant != 1.0)
    errors.push_back({cv, input, MismatchParameter::time_constant, time_constant});
  if (const double shift = std::max(0.0, dead_time) - model.dead_time(); shift != 0.0)
    errors.push_back({cv, input, MismatchParameter::dead_time, shift});
  if (lag > 0.0)
    errors.push_back({cv, input, MismatchParameter::second_order, lag});
}

BackgroundNoise draw_background(const BackgroundRanges& ranges, const Distribution& size, double unit,
                                RandomStream& stream) {
  const double share = size.sample(stream);
  const double deviation =
      share > 0.0 ? share * unit : 0.0;  // an MV without limits has no unit, and no noise
  const double time_constant = ranges.time_constant.sample(stream);
  return {deviation, time_constant > 0.0 ? std::exp(-1.0 / time_constant) : 0.0};
}

Eigen::MatrixXd values_of(const std::vector<BackgroundNoise>& noise, Eigen::Index samples,
                          RandomStream& stream) {
  Eigen::MatrixXd x(static_cast<Eigen::Index>(noise.size()), samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    for (Eigen::Index row = 0; row < x.rows(); ++row) {
      const auto& [deviation, pole] = noise[static_cast<std::size_t>(row)];
      const double white = deviation * stream.normal();
      x(row, k) = k == 0 ? white : pole * x(row, k - 1) + std::sqrt(1.0 - pole * pole) * white;
    }
  return x;
}

/// Draws the properties that errors of channels cannot express, each from a stream of its own.
void draw_structure(const Study& study, int number, World& world) {
  const auto stream_of = [&](StreamId id) {
    return RandomStream(study.seed, static_cast<std::uint64_t>(number), id);
  };
  const WorldRanges& ranges = *study.world;
  if (!(ranges.background.swell == Distribution::constant(1.0))) {
    RandomStream stream = stream_of(StreamId::background_swell);
    world.background_swell = ranges.background.swell.sample(stream);
  }
  if (!(ranges.valve_curvature == Distribution::constant(0.0))) {
    RandomStream stream = stream_of(StreamId::world_valves);
    world.valve_curvature.resize(study.mv_count());
    for (double& curvature : world.valve_curvature)
      curvature = ranges.valve_curvature.sample(stream);
  }
}

/// Scales the signals so that their size grows and shrinks once over the record.
void swell(double by, double phase, Eigen::MatrixXd& signals) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(signals.cols());
  for (Eigen::Index k = 0; k < signals.cols(); ++k)
    signals.col(k) *= std::pow(by, std::sin(step * static_cast<double>(k) + phase) / 2.0);
}

bool is_silent(const std::vector<BackgroundNoise>& noise) {
  return std::all_of(noise.begin(), noise.end(),
                     [](const BackgroundNoise& each) { return each.standard_deviation == 0.0; });
}

}  // namespace

World draw_world(const Study& study, int number) {
  World world;
  world.noise_factor.setOnes(study.cv_count());
  if (number == kExactWorld)
    return world;
  const WorldRanges& ranges = *study.world;
  RandomStream stream(study.seed, static_cast<std::uint64_t>(number), StreamId::world);
  const TransferMatrix& G = study.plant.G;
  for (Eigen::Index cv = 0; cv < G.rows() && !study.nonlinear; ++cv)
    for (Eigen::Index input = 0; input < G.cols(); ++input)
      if (!G(cv, input).is_zero())
        draw_errors(ranges, G(cv, input), cv, input, stream, world.errors);
  for (const WorldParameter& parameter : ranges.plant_parameters)
    world.parameters.push_back(
        {parameter.name, nominal_value(study, parameter.name) * parameter.factor.sample(stream)});
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    world.noise_factor(cv) = ranges.noise_factor.sample(stream);
    world.cv_background.push_back(draw_background(ranges.background, ranges.background.cv_size,
                                                  study.simulation.noise_standard_deviation(cv), stream));
  }
  const Limits& hard = study.controller.mv_hard;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    world.mv_background.push_back(draw_background(ranges.background, ranges.background.mv_size,
                                                  hard.upper(mv) - hard.lower(mv), stream));
  draw_structure(study, number, world);
  return world;
}

int world_of(const Study& study, std::int64_t index) {
  if (!study.world)
    return kExactWorld;
  const std::int64_t before =
      study.names_scenarios() ? index : KindSequence(study.experiments).earlier(index);
  return static_cast<int>(before % study.world->count);
}

TransferMatrix world_plant(const Study& study, const World& world) {
  return with_mismatches(study.plant.G, world.errors);
}

TransferMatrix with_world_mismatches(TransferMatrix plant, std::vector<Mismatch> mismatches) {
  for (Mismatch& mismatch : mismatches) {
    if (mismatch.parameter == MismatchParameter::dead_time)
      mismatch.value = std::max(mismatch.value, -plant(mismatch.cv, mismatch.input).dead_time());
    plant = with_mismatches(std::move(plant), {mismatch});
  }
  return plant;
}

std::vector<ParameterChange> with_world_parameters(const Study& study, const World& world,
                                                   std::vector<ParameterChange> changes) {
  for (ParameterChange& change : changes)
    for (const ParameterChange& own : world.parameters)
      if (own.name == change.name)
        change.value *= own.value / nominal_value(study, change.name);
  return changes;
}

Background background(const Study& study, const World& world, std::int64_t index) {
  RandomStream stream = experiment_stream(study, index, StreamId::background);
  Background added;
  if (!is_silent(world.cv_background))
    added.y_d = values_of(world.cv_background, study.simulation.samples, stream);
  if (!is_silent(world.mv_background))
    added.u_d = values_of(world.mv_background, study.simulation.samples, stream);
  if (world.background_swell != 1.0) {
    const double phase =
        experiment_stream(study, index, StreamId::background_swell).uniform(0.0, 2.0 * std::numbers::pi);
    swell(world.background_swell, phase, added.y_d);
    swell(world.background_swell, phase, added.u_d);
  }
  return added;
}

}  // namespace mpm
