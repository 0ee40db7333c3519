#include "analysis/experiment/repair.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/experiment/repaired_model.hpp"
#include "analysis/indicators/loop_cost.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

Eigen::VectorXd variances_of(const Study& study, const Trajectory& loop,
                             const std::vector<bool>& counted = {}) {
  if (loop.status != ControlStatus::ok)
    return {};
  if (!counted.empty())
    return counted_costs(study, loop, counted);
  return variances(loop.y, variance_centres(study, 0, loop.y.cols()));
}

Study with_repair(Study study, const ChannelRepair& repair) {
  study.plant.G(repair.channel.cv, repair.channel.mv) = repair.model;
  return study;
}

/// The loop that the repaired model promises.
Trajectory promised(const Study& repaired, const OperatingPoint& point, const AssessedLoop& loop,
                    const QpSolverFactory& factory) {
  const Eigen::MatrixXd errors =
      loop.y -
      simulated_output(repaired.assessed_model(), repaired.controller.sample_time, point.u, loop.u, loop.d);
  const LoopSignals signals{.d = loop.d,
                            .noise = Eigen::MatrixXd::Zero(errors.rows(), errors.cols()),
                            .y_d = from_washout(repaired, errors.array().isNaN().select(0.0, errors)),
                            .y_set = setpoints(repaired),
                            .dither = dither(repaired)};
  return run_closed_loop(repaired, repaired.plant.G, signals, factory);
}

/// The repair in which the size that a method names is the correction.
ChannelRepair of_size(const Study& study, const NamedMismatch& named) {
  const TransferFunction& model = study.plant.G(named.channel.cv, named.channel.mv);
  ChannelRepair repair{.channel = named.channel,
                       .named = named,
                       .parameter = named.parameter,
                       .gain_factor = {1.0, 1.0, 1.0},
                       .time_factor = {1.0, 1.0, 1.0},
                       .dead_time_shift = {0.0, 0.0, 0.0},
                       .model = model};
  double size = named.size;
  if (named.parameter == MismatchParameter::dead_time)
    size = std::max(size, -model.dead_time());  // rounding
  const FittedNumber number{size, named.lower, named.upper, named.bound};
  if (named.parameter == MismatchParameter::gain || named.parameter == MismatchParameter::sign)
    repair.gain_factor = number;
  else if (named.parameter == MismatchParameter::time_constant)
    repair.time_factor = number;
  else if (named.parameter == MismatchParameter::dead_time)
    repair.dead_time_shift = number;
  repair.model =
      with_mismatches(study.plant.G, {{named.channel.cv, named.channel.mv, named.parameter, size}})(
          named.channel.cv, named.channel.mv);
  return repair;
}

}  // namespace

ChannelRepair identified_channel(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                                 const Channel& channel, const std::optional<MismatchParameter>& only,
                                 const FitSurroundings& beside) {
  const Eigen::VectorXd e = (loop.y.row(channel.cv) - loop.y_sim.row(channel.cv)).transpose();
  const ChannelFit fit = fit_channel(study.assessed_channel(channel.cv, channel.mv),
                                     study.controller.sample_time, e, loop.u.row(channel.mv).transpose(),
                                     point.u(channel.mv), study.aggregate.confidence, only, beside);
  return {.channel = channel,
          .named = {},
          .parameter = only,
          .gain_factor = fit.gain_factor,
          .time_factor = fit.time_factor,
          .dead_time_shift = fit.dead_time_shift,
          .explained = fit.explained,
          .model = fit.channel.without_washout()};
}

std::optional<ChannelRepair> channel_repair(const Study& study, const OperatingPoint& point,
                                            const AssessedLoop& loop, const AssessmentRecord& said) {
  const std::optional<Channel> channel = channel_to_repair(said);
  if (!channel)
    return std::nullopt;
  const std::optional<NamedMismatch> named = said.named_mismatch();
  if (named && !std::isnan(named->size))
    return of_size(study, *named);
  return identified_channel(
      study, point, loop, *channel,
      named && is_fitted_alone(named->parameter) ? std::optional(named->parameter) : std::nullopt);
}

PromisedRepair promised_repair(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                               const ChannelRepair& repair, const QpSolverFactory& factory,
                               const std::vector<bool>& counted) {
  return {
      .repair = repair,
      .now = variances_of(study, promised(study, point, loop, factory), counted),
      .predicted = variances_of(study, promised(with_repair(study, repair), point, loop, factory), counted)};
}

RepairedLoop repaired_loop(const Study& study, const OperatingPoint& point, const ExperimentDraw& draw,
                           const AssessedLoop& loop, const ChannelRepair& repair,
                           const QpSolverFactory& factory) {
  if (study.simulation.excitation == SignalSequence::each)
    return repaired_loop(with_excitation(study, draw.index), point, draw, loop, repair, factory);
  const Study repaired = with_repair(study, repair);
  const auto variances_with = [&](const TransferMatrix& model, const ExperimentDraw& seen) {
    return variances_of(study, loop_with_model(study, model, seen, factory));
  };
  return {.repair = repair,
          .now = variances_with(study.plant.G, draw),
          .predicted = variances_of(study, promised(repaired, point, loop, factory)),
          .repaired = variances_with(repaired.plant.G, draw),
          .perfect = study.nonlinear ? variances_with(study.plant.G, draw.disturbance_alone())
                                     : variances_with(true_plant(study, draw), draw)};
}

std::optional<Channel> channel_to_repair(const AssessmentRecord& said) {
  return said.answered() && said.flagged ? named_channel(said) : std::nullopt;
}

std::optional<Channel> named_channel(const AssessmentRecord& said) {
  if (const std::optional<NamedMismatch> named = said.named_mismatch())
    return named->channel;
  const Eigen::MatrixXd flags = said.values("channel_flagged");
  for (Eigen::Index cv = 0; cv < flags.rows(); ++cv)
    for (Eigen::Index mv = 0; mv < flags.cols(); ++mv)
      if (flags(cv, mv) == 1.0)
        return Channel{cv, mv};
  return std::nullopt;
}

}  // namespace mpm
