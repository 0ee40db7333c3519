#include "analysis/experiment/fault_scale.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "analysis/indicators/diagnosis.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr double kLargestScale = 1024.0, kSmallestScale = 1.0 / 1024.0;
constexpr double kLargestSizedFactor = 10.0;  // of a gain or a time constant; its inverse is the smallest
constexpr double kTolerance = 0.03;           // of the effect, relative
constexpr int kMostPilots = 16;

/// The scale at which `factor`^scale reaches the end of [low, high] that it moves towards.
double scale_to_end(double factor, double low, double high) {
  const double end = factor > 1.0 ? high : low;
  return factor == 1.0 ? kLargestScale : std::log(end) / std::log(factor);
}

double largest_scale(const Study& study, const Mismatch& mismatch) {
  switch (mismatch.parameter) {
    case MismatchParameter::gain:
    case MismatchParameter::time_constant:
      return scale_to_end(mismatch.value, 1.0 / kLargestSizedFactor, kLargestSizedFactor);
    case MismatchParameter::dead_time:
      return mismatch.value < 0.0 ? study.plant.G(mismatch.cv, mismatch.input).dead_time() / -mismatch.value
                                  : kLargestScale;
    case MismatchParameter::second_order:
    case MismatchParameter::inverse_response:
    case MismatchParameter::sign:
    case MismatchParameter::channel:
      break;
  }
  return kLargestScale;
}

double largest_scale(const Study& study, const ParameterChange& change) {
  const auto& ranges = study.mismatch.plant_parameters;
  const auto named = [&](const PlantParameterRange& each) { return each.name == change.name; };
  const Distribution& range = std::find_if(ranges.begin(), ranges.end(), named)->factor;
  return scale_to_end(change.value / nominal_value(study, change.name), range.minimum(), range.maximum());
}

double largest_scale(const Study& study, const ExperimentDraw& draw) {
  double largest = kLargestScale;
  for (const Mismatch& mismatch : draw.mismatches)
    largest = std::min(largest, largest_scale(study, mismatch));
  for (const ParameterChange& change : draw.parameters)
    largest = std::min(largest, largest_scale(study, change));
  return largest;
}

/// The argument in [kSmallestScale, largest] at which `effect` is nearest to `target`. Brackets it from 1 by
/// factors of 4, then interpolates linearly between the ends of the bracket, both axes logarithmic, at a
/// distance from the ends.
double scale_with_effect(const std::function<double(double)>& effect, double target, double largest) {
  int pilots = 0;
  double best = 1.0, best_error = kInfinity;
  const auto evaluate = [&](double scale) {
    ++pilots;
    const double value = effect(scale);
    const double error = std::abs(std::log(value / target));
    if (error < best_error || (best_error == kInfinity && scale < best)) {
      best = scale;
      best_error = error;
    }
    return value;
  };
  const auto is_done = [&] { return best_error < kTolerance || pilots >= kMostPilots; };
  double low = std::min(1.0, largest), high = low;
  double low_value = evaluate(low), high_value = low_value;
  while (low_value > target && low > kSmallestScale && !is_done()) {
    high = low;
    high_value = low_value;
    low = std::max(low / 4.0, kSmallestScale);
    low_value = evaluate(low);
  }
  while (high_value < target && high < largest && !is_done()) {
    low = high;
    low_value = high_value;
    high = std::min(4.0 * high, largest);
    high_value = evaluate(high);
  }
  while (low_value < target && high_value > target && !is_done()) {
    const double share =
        std::isfinite(high_value) && low_value > 0.0
            ? std::clamp(std::log(target / low_value) / std::log(high_value / low_value), 0.2, 0.8)
            : 0.5;
    const double middle = low * std::pow(high / low, share);
    const double value = evaluate(middle);
    (value < target ? low : high) = middle;
    (value < target ? low_value : high_value) = value;
  }
  return best;
}

}  // namespace

bool has_asked_impact(const Study& study, const ExperimentDraw& draw) {
  return (study.mismatch.impact && !(draw.mismatches.empty() && draw.parameters.empty())) ||
         (study.disturbance.impact && !draw.disturbances.empty()) || (study.other.impact && draw.other);
}

double effect(const Study& study, const ExperimentDraw& draw, const Trajectory& loop,
              const Eigen::MatrixXd& y_basis) {
  if (loop.status != ControlStatus::ok)
    return kInfinity;
  const Eigen::VectorXd ivar = basis_variance_indices(study, loop.y, y_basis);
  double largest = 0.0;
  for (const AffectedCv& affected : draw.affected())
    largest = std::max(largest, std::abs(ivar(affected.cv) - 1.0));
  return largest;
}

FaultScales scales_for_impact(const Study& study, const ExperimentDraw& draw, const Eigen::MatrixXd& y_basis,
                              const QpSolverFactory& factory, SolverStatistics& pilots,
                              const StepObserver& observer) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(draw.index), StreamId::impact);
  FaultScales scales;
  const auto solve = [&](const ExperimentDraw& alone, const std::optional<Distribution>& impact,
                         double FaultScales::*scale) {
    const double target = impact ? impact->sample(stream) : kNaN;
    if (!impact || is_faultless(alone.kind))
      return;
    const auto effect_at = [&](double at) {
      FaultScales tried;
      tried.*scale = at;
      const ExperimentDraw experiment = with_scales(study, alone, tried);
      const Trajectory loop = simulate_experiment(study, experiment, factory, observer);
      pilots.add(loop.solver);
      return effect(study, experiment, loop, y_basis);
    };
    scales.*scale = scale_with_effect(effect_at, target, largest_scale(study, alone));
  };
  if (draw.other) {
    solve(draw, study.other.impact, &FaultScales::other);
    return scales;
  }
  solve(draw.mismatch_alone(), study.mismatch.impact, &FaultScales::mismatch);
  solve(draw.disturbance_alone(), study.disturbance.impact, &FaultScales::disturbance);
  return scales;
}

}  // namespace mpm
