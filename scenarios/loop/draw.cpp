#include "scenarios/loop/draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/loop/kind_sequence.hpp"
#include "scenarios/loop/world.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

double scaled(const Mismatch& mismatch, double scale) {
  switch (mismatch.parameter) {
    case MismatchParameter::gain:
    case MismatchParameter::time_constant:
      return std::pow(mismatch.value, scale);
    case MismatchParameter::dead_time:
    case MismatchParameter::second_order:
    case MismatchParameter::inverse_response:
      return scale * mismatch.value;
    case MismatchParameter::sign:
    case MismatchParameter::channel:
      break;
  }
  return mismatch.value;
}

TuningChange draw_tuning(const Study& study, std::int64_t index) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(index), StreamId::tuning);
  const std::array<double, 4> weights = study.tuning.weights_for(study.controller);
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; }))
    throw InputError("tuning.parameter_weights", "a weight of 0 for everything that the controller has",
                     "at least one > 0");
  const TuningParameter parameter = kTuningParameters[draw_place(weights, stream)];
  const std::vector<Eigen::Index> variables = variables_with(study.controller, parameter);
  const Eigen::Index variable = variables[stream.below(variables.size())];
  return {parameter, variable, study.tuning.factor.sample(stream)};
}

double draw_noise_factor(const Study& study, std::int64_t index) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(index), StreamId::noise_factor);
  return study.simulation.noise.factor.sample(stream);
}

ExperimentDraw named_experiment(const Study& study, std::int64_t index) {
  if (index >= study.experiment_count())
    throw InputError("experiment index", fmt::format("{}", index),
                     fmt::format("0 to {}, the named scenarios of the study", study.experiment_count() - 1));
  const Scenario& scenario = study.scenarios[static_cast<std::size_t>(index)];
  ExperimentDraw draw{index,
                      kind_of(scenario.mismatches, scenario.parameters, scenario.disturbances),
                      scenario.mismatches,
                      scenario.disturbances,
                      true,
                      scenario.affected_cvs,
                      scenario.parameters};
  draw.noise_factor = draw_noise_factor(study, index);
  draw.world = world_of(study, index);
  return draw;
}

}  // namespace

ExperimentDraw draw_experiment(const Study& study, std::int64_t index) {
  if (index < 0)
    throw InputError("experiment index", fmt::format("{}", index), ">= 0");
  if (study.names_scenarios())
    return named_experiment(study, index);
  ExperimentDraw draw;
  draw.index = index;
  draw.world = world_of(study, index);
  draw.noise_factor = draw_noise_factor(study, index);
  draw.kind = KindSequence(study.experiments)[index];
  const bool both = draw.kind == ExperimentKind::mpm_ud;
  if (draw.kind == ExperimentKind::mpm || both)
    draw_mismatch(study, draw);
  if (draw.kind == ExperimentKind::ud || both)
    draw_disturbance(study, draw);
  if (draw.kind == ExperimentKind::tuning)
    draw.tuning = draw_tuning(study, index);
  if (draw.kind == ExperimentKind::other)
    draw_other_fault(study, draw);
  if (!is_faultless(draw.kind))
    draw.onset = draw_onset(study, index);
  return draw;
}

ExperimentDraw with_scales(const Study& study, ExperimentDraw draw, const FaultScales& scales) {
  if (scales == FaultScales{})
    return draw;
  for (Mismatch& mismatch : draw.mismatches)
    mismatch.value = scaled(mismatch, scales.mismatch);
  for (ParameterChange& parameter : draw.parameters) {
    const double nominal = nominal_value(study, parameter.name);
    parameter.value = nominal * std::pow(parameter.value / nominal, scales.mismatch);
  }
  for (Disturbance& disturbance : draw.disturbances)
    disturbance.gain *= scales.disturbance;
  if (draw.other) {
    OtherFault& fault = *draw.other;
    fault.size =
        info_of(fault.kind).is_factor ? std::pow(fault.size, scales.other) : scales.other * fault.size;
    fault.jump *= scales.other;
  }
  draw.scales = scales;
  return draw;
}

ExperimentDraw basis_draw(int world) {
  ExperimentDraw draw;
  draw.index = basis_index(world);
  draw.world = world;
  return draw;
}

Study with_tuning(const Study& study, const ExperimentDraw& draw) {
  Study changed = study;
  if (draw.tuning)
    changed.controller = with_tuning(std::move(changed.controller), *draw.tuning);
  return changed;
}

}  // namespace mpm
