#include "scenarios/loop/fault_draw.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

template <class T>
T draw_from(const std::vector<T>& list, RandomStream& stream) {
  return list[stream.below(list.size())];
}

double either_sign(double value, RandomStream& stream) {
  return stream.uniform() < 0.5 ? -value : value;
}

/// 0 to count - 1.
std::vector<Eigen::Index> every_place(Eigen::Index count) {
  std::vector<Eigen::Index> places(static_cast<std::size_t>(count));
  std::iota(places.begin(), places.end(), Eigen::Index{0});
  return places;
}

// --- Mismatches ---

// A dead time cannot become negative: a bounded distribution is shrunk onto what is possible, so that the
// draw still gives a mismatch; an unbounded one is cut off.
double possible_shift(double shift, const Distribution& distribution, double dead_time) {
  if (distribution.minimum() >= -dead_time)
    return shift;
  const double span = distribution.maximum() - distribution.minimum();
  if (!std::isfinite(span) || span == 0.0 || distribution.maximum() <= -dead_time)
    return std::max(shift, -dead_time);
  const double quantile = (shift - distribution.minimum()) / span;
  return -dead_time + quantile * (distribution.maximum() + dead_time);
}

/// The residence time of a channel, at least a sample: a channel without dynamics gets a lag of that size.
double residence_time(const Study& study, const TransferFunction& channel) {
  return std::max(std::abs(channel.residence_time()), study.controller.sample_time);
}

/// Draws a mismatch of this parameter; if the channel has no time constant to change, of its gain.
Mismatch mismatch_of(const Study& study, ChannelPlace place, MismatchParameter parameter,
                     RandomStream& stream) {
  const MismatchRanges& ranges = study.mismatch;
  const TransferFunction& channel = study.plant.G(place.first, place.second);
  if (parameter == MismatchParameter::time_constant && !channel.has_time_constant())
    parameter = MismatchParameter::gain;
  double value = -1.0;  // of a sign
  switch (parameter) {
    case MismatchParameter::gain:
      value = ranges.gain_factor.sample(stream);
      break;
    case MismatchParameter::time_constant:
      value = ranges.time_constant_factor.sample(stream);
      break;
    case MismatchParameter::dead_time:
      value =
          possible_shift(ranges.dead_time_shift.sample(stream), ranges.dead_time_shift, channel.dead_time());
      break;
    case MismatchParameter::second_order:
      value = ranges.second_order.sample(stream) * residence_time(study, channel);
      break;
    case MismatchParameter::inverse_response:
      value = ranges.inverse_response.sample(stream) * residence_time(study, channel);
      break;
    case MismatchParameter::sign:
      break;
    case MismatchParameter::channel:
      assert(false);  // is never drawn
      break;
  }
  return {place.first, place.second, parameter, value};
}

/// All mismatches of an experiment with this extent, from the first one.
std::vector<Mismatch> reaching(const Study& study, MismatchExtent extent, const Mismatch& first,
                               RandomStream& stream) {
  std::vector<Mismatch> mismatches;
  switch (extent) {
    case MismatchExtent::parameter:
      return {first};
    case MismatchExtent::channel:
      for (const MismatchParameter parameter :
           {MismatchParameter::gain, MismatchParameter::time_constant, MismatchParameter::dead_time})
        if (parameter != MismatchParameter::time_constant ||
            study.plant.G(first.cv, first.input).has_time_constant())
          mismatches.push_back(mismatch_of(study, {first.cv, first.input}, parameter, stream));
      return mismatches;
    case MismatchExtent::cv:
      for (const ChannelPlace& place : mismatch_channels(study))
        if (place.first == first.cv)
          mismatches.push_back(
              place.second == first.input ? first : mismatch_of(study, place, first.parameter, stream));
      return mismatches;
    case MismatchExtent::plant:
      for (const ChannelPlace& place : mismatch_channels(study))
        mismatches.push_back(place == ChannelPlace{first.cv, first.input}
                                 ? first
                                 : mismatch_of(study, place, first.parameter, stream));
      return mismatches;
    case MismatchExtent::mv: {
      const double factor = study.mismatch.gain_factor.sample(stream);
      for (const auto& [cv, mv] : mismatch_channels(study))
        if (mv == first.input)
          mismatches.push_back({cv, mv, MismatchParameter::gain, factor});
      return mismatches;
    }
  }
  return {first};
}

void draw_plant_parameter(const Study& study, ExperimentDraw& draw, RandomStream& stream) {
  const std::vector<PlantParameterRange>& ranges = study.mismatch.plant_parameters;
  const PlantParameterRange& range = ranges[stream.below(ranges.size())];
  draw.parameters = {{range.name, nominal_value(study, range.name) * range.factor.sample(stream)}};
  draw.affected_cvs = range.affected_cvs;
}

// --- Disturbances ---

/// A step or a ramp begins between these shares of the record.
constexpr double kEarliest = 0.1, kLatest = 0.6;
/// The period of a sine lies between this number of samples and this share of the record.
constexpr double kShortestPeriod = 8.0, kLongestPeriod = 0.25;
constexpr std::uint64_t kMostCvs = 3;  // of one disturbance

/// A signal of this shape, whose size is not yet set (of_equal_effect()).
DisturbanceSignal signal_of_shape(const Study& study, DisturbanceShape shape, RandomStream& stream) {
  const double N = study.simulation.samples;
  const double Ts = study.controller.sample_time;
  const double begin = stream.uniform(kEarliest, kLatest) * N;
  const double sign = either_sign(1.0, stream);
  switch (shape) {
    case DisturbanceShape::white:
      return WhiteNoise{};
    case DisturbanceShape::step:
      return StepSequence{{{static_cast<int>(begin), sign}}};
    case DisturbanceShape::ramp:
      return Ramp{sign / (N * Ts), begin * Ts};
    case DisturbanceShape::random_walk:
      return RandomWalk{};
    case DisturbanceShape::sine: {
      const double longest = std::max(kLongestPeriod * N, kShortestPeriod + 1.0);
      return Sine{sign, Ts * Distribution::log_uniform(kShortestPeriod, longest).sample(stream)};
    }
    case DisturbanceShape::burst:
      return Bursts{};
  }
  return WhiteNoise{};
}

/// The stationary standard deviation of y_d = G_d v for white v held over a sample, with the first-order G_d
/// of the disturbance: |gain| sigma sqrt((1 - a) / (1 + a)), a = e^(-Ts / time constant).
double white_deviation(const Study& study, const Disturbance& disturbance) {
  const double a = std::exp(-study.controller.sample_time / disturbance.time_constant);
  return std::abs(disturbance.gain) * study.disturbance.v_standard_deviation *
         std::sqrt((1.0 - a) / (1.0 + a));
}

double standard_deviation_of(const Eigen::RowVectorXd& y) {
  return std::sqrt((y.array() - y.mean()).square().mean());
}

/// The signal of the first disturbance, scaled so that y_d has the standard deviation that white v would give
/// it.
DisturbanceSignal of_equal_effect(const Study& study, std::int64_t index, const Disturbance& first) {
  const double deviation = standard_deviation_of(disturbance_output(study, index, first));
  return deviation > 0.0 ? scaled(first.signal, white_deviation(study, first) / deviation) : first.signal;
}

/// Extends the first disturbance to one or two other CVs.
void reach_further(const Study& study, ExperimentDraw& draw, RandomStream& stream) {
  std::vector<Eigen::Index> others = disturbance_cvs(study);
  std::erase(others, draw.disturbances.front().cv);
  const auto most = std::min<std::uint64_t>(kMostCvs - 1, others.size());
  for (std::uint64_t more = most == 0 ? 0 : 1 + stream.below(most); more > 0; --more) {
    const auto place = others.begin() + static_cast<std::ptrdiff_t>(stream.below(others.size()));
    Disturbance further{*place, study.disturbance.gain.sample(stream),
                        study.disturbance.time_constant.sample(stream)};
    further.shares_signal = true;
    draw.disturbances.push_back(std::move(further));
    others.erase(place);
  }
}

std::vector<Eigen::Index> cvs_with_channel(const Study& study, Eigen::Index input) {
  std::vector<Eigen::Index> cvs;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (!study.plant.G(cv, input).is_zero())
      cvs.push_back(cv);
  return cvs;
}

/// Adds these CVs to those that the experiment affects.
void add_affected(ExperimentDraw& draw, std::vector<Eigen::Index> cvs) {
  for (const AffectedCv& affected : draw.affected())
    cvs.push_back(affected.cv);
  std::sort(cvs.begin(), cvs.end());
  cvs.erase(std::unique(cvs.begin(), cvs.end()), cvs.end());
  draw.affected_cvs = std::move(cvs);
}

std::vector<Eigen::Index> cvs_of(const std::vector<Disturbance>& disturbances) {
  std::vector<Eigen::Index> cvs;
  for (const Disturbance& disturbance : disturbances)
    cvs.push_back(disturbance.cv);
  return cvs;
}

/// Moves the disturbance from the CV to an MV, at the size at which the CV with the largest gain from this MV
/// sees the drawn size.
void move_to_mv(const Study& study, ExperimentDraw& draw, RandomStream& stream) {
  const Eigen::Index mv = draw_from(mv_channels(study), stream).second;
  Disturbance& disturbance = draw.disturbances.front();
  disturbance.cv = -1;
  disturbance.mv = mv;
  disturbance.gain /= study.assessed_model().static_gain().col(mv).cwiseAbs().maxCoeff();
  add_affected(draw, cvs_with_channel(study, mv));
}

// --- Other faults ---

std::vector<Eigen::Index> moving_mds(const Study& study) {
  const Eigen::MatrixXd d = measured_disturbances(study);
  std::vector<Eigen::Index> mds;
  for (Eigen::Index md = 0; md < d.rows(); ++md)
    if (!d.row(md).isZero(0))
      mds.push_back(md);
  return mds;
}

bool is_limited(const Study& study, Eigen::Index cv) {
  return std::isfinite(study.controller.cv_soft.lower(cv)) ||
         std::isfinite(study.controller.cv_soft.upper(cv));
}

/// Upper minus lower limit; 1 if a limit is missing.
double width(const Limits& limits, Eigen::Index variable) {
  const double range = limits.upper(variable) - limits.lower(variable);
  return std::isfinite(range) && range > 0.0 ? range : 1.0;
}

std::vector<Eigen::Index> variables_of(const Study& study, OtherFaultKind kind) {
  const OtherFaultInfo& info = info_of(kind);
  if (info.sort == VariableSort::md)
    return moving_mds(study);
  std::vector<Eigen::Index> variables =
      every_place(info.sort == VariableSort::cv ? study.cv_count() : study.mv_count());
  if (info.effect == FaultEffect::limit)
    std::erase_if(variables, [&](Eigen::Index cv) { return !is_limited(study, cv); });
  return variables;
}

double unit_size(const Study& study, SizeUnit unit, Eigen::Index variable) {
  switch (unit) {
    case SizeUnit::noise: {
      const double noise = study.simulation.noise_standard_deviation(variable);
      return noise > 0.0 ? noise : 1.0;
    }
    case SizeUnit::hard_range:
      return width(study.controller.mv_hard, variable);
    case SizeUnit::soft_range:
      return width(study.controller.cv_soft, variable);
    case SizeUnit::own:
      break;
  }
  return 1.0;
}

OtherFault other_fault(const Study& study, OtherFaultKind kind, Eigen::Index variable, RandomStream& stream) {
  const OtherFaultInfo& info = info_of(kind);
  OtherFault fault{kind, variable};
  if (info.size == nullptr)
    return fault;
  fault.size = (study.other.*info.size).sample(stream) * unit_size(study, info.unit, variable);
  if (info.has_either_sign)
    fault.size = either_sign(fault.size, stream);
  if (info.jump != nullptr)
    fault.jump = (study.other.*info.jump).sample(stream) * fault.size;
  return fault;
}

}  // namespace

std::vector<ChannelPlace> mv_channels(const Study& study) {
  std::vector<ChannelPlace> channels;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      if (!study.plant.G(cv, mv).is_zero())
        channels.emplace_back(cv, mv);
  if (channels.empty())
    throw InputError("plant", "no channel from an MV to a CV", "at least one");
  return channels;
}

std::vector<ChannelPlace> mismatch_channels(const Study& study) {
  return study.mismatch.channels.empty() ? mv_channels(study) : study.mismatch.channels;
}

std::vector<Eigen::Index> disturbance_cvs(const Study& study) {
  return study.disturbance.cvs.empty() ? every_place(study.cv_count()) : study.disturbance.cvs;
}

double nominal_value(const Study& study, std::string_view parameter) {
  const std::vector<NonlinearModel::Parameter>& parameters = study.nonlinear->model.parameters;
  const auto place = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const auto& each) { return each.name == parameter; });
  assert(place != parameters.end());
  return place->nominal;
}

std::size_t draw_place(std::span<const double> weights, RandomStream& stream) {
  const double point = stream.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    if (point < sum)
      return i;
    if (weights[i] > 0.0)
      last = i;
  }
  return last;  // by rounding only
}

void draw_mismatch(const Study& study, ExperimentDraw& draw) {
  RandomStream stream = experiment_stream(study, draw.index, StreamId::mismatch);
  if (study.nonlinear) {
    draw_plant_parameter(study, draw, stream);
    return;
  }
  const ChannelPlace channel = draw_from(mismatch_channels(study), stream);
  const auto parameter = kRandomMismatchParameters[draw_place(study.mismatch.parameter_weight, stream)];
  const Mismatch first = mismatch_of(study, channel, parameter, stream);
  RandomStream further = experiment_stream(study, draw.index, StreamId::mismatch_extent);
  const auto extent = kMismatchExtents[draw_place(study.mismatch.extent_weight, further)];
  draw.mismatches = reaching(study, extent, first, further);
}

void draw_disturbance(const Study& study, ExperimentDraw& draw) {
  RandomStream stream = experiment_stream(study, draw.index, StreamId::disturbance_draw);
  const Eigen::Index cv = draw_from(disturbance_cvs(study), stream);
  const double gain = study.disturbance.gain.sample(stream);
  const double time_constant = study.disturbance.time_constant.sample(stream);
  draw.disturbances = {{draw.mismatches.empty() ? cv : draw.mismatches.front().cv, gain, time_constant}};
  RandomStream further = experiment_stream(study, draw.index, StreamId::disturbance_shape);
  const auto shape = kDisturbanceShapes[draw_place(study.disturbance.signal_weight, further)];
  const auto place = kDisturbancePlaces[draw_place(study.disturbance.place_weight, further)];
  Disturbance& first = draw.disturbances.front();
  if (shape != DisturbanceShape::white) {
    first.signal = signal_of_shape(study, shape, further);
    first.signal = of_equal_effect(study, draw.index, first);
  }
  if (place == DisturbancePlace::several)
    reach_further(study, draw, further);
  if (place == DisturbancePlace::mv)
    move_to_mv(study, draw, further);
  else if (draw.affected_cvs)
    add_affected(draw, cvs_of(draw.disturbances));
}

void draw_other_fault(const Study& study, ExperimentDraw& draw) {
  RandomStream stream = experiment_stream(study, draw.index, StreamId::other_fault);
  const auto weights = other_weights(study);
  const OtherFaultKind kind = kOtherFaultKinds[draw_place(weights, stream)];
  const Eigen::Index variable = draw_from(variables_of(study, kind), stream);
  draw.other = other_fault(study, kind, variable, stream);
  if (study.other.valve_start == ValveStart::unknown && info_of(kind).effect == FaultEffect::valve)
    draw.other->start = experiment_stream(study, draw.index, StreamId::valve_start).uniform(-1.0, 1.0);
  const VariableSort sort = info_of(kind).sort;
  draw.affected_cvs =
      sort == VariableSort::cv
          ? std::vector<Eigen::Index>{variable}
          : cvs_with_channel(study, sort == VariableSort::mv ? variable : study.mv_count() + variable);
}

Onset draw_onset(const Study& study, std::int64_t index) {
  RandomStream stream = experiment_stream(study, index, StreamId::onset);
  const double sample = study.onset.sample.sample(stream);
  const double growth = study.onset.growth.sample(stream);
  return {static_cast<int>(sample), static_cast<int>(growth)};
}

std::array<double, kOtherFaultKinds.size()> other_weights(const Study& study) {
  std::array<double, kOtherFaultKinds.size()> weights = study.other.weight;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (variables_of(study, kOtherFaultKinds[i]).empty())
      weights[i] = 0.0;
  return weights;
}

}  // namespace mpm
