#include "analysis/experiment/repair.hpp"

#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/loop/world.hpp"

namespace mpm {
namespace {

/// The experiment as a controller with another model sees it: the plant differs from this model in every
/// channel in which it is not the same; in a world every channel is said, so that none gets its errors twice.
ExperimentDraw against(const TransferMatrix& model, const TransferMatrix& plant, ExperimentDraw draw) {
  draw.mismatches.clear();
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv)
    for (Eigen::Index input = 0; input < plant.cols(); ++input)
      if (draw.world != kExactWorld || !(model(cv, input) == plant(cv, input)))
        draw.mismatches.push_back({cv, input, MismatchParameter::channel, 1.0, plant(cv, input)});
  return draw;
}

Eigen::VectorXd variances_of(const Study& study, const Trajectory& loop) {
  if (loop.status != ControlStatus::ok)
    return {};
  return variances(loop.y, variance_centres(study, 0, loop.y.cols()));
}

/// The loop that the repaired model promises.
Trajectory promised(const Study& repaired, const OperatingPoint& point, const AssessedLoop& loop,
                    const QpSolverFactory& factory) {
  const Eigen::MatrixXd errors =
      loop.y - simulated_output(repaired.plant.G, repaired.controller.sample_time, point.u, loop.u, loop.d);
  const LoopSignals signals{.d = loop.d,
                            .noise = Eigen::MatrixXd::Zero(errors.rows(), errors.cols()),
                            .y_d = errors.array().isNaN().select(0.0, errors),
                            .y_set = setpoints(repaired),
                            .dither = dither(repaired)};
  return run_closed_loop(repaired, repaired.plant.G, signals, factory);
}

ChannelFit fit_of(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                  const Channel& channel, const std::optional<MismatchParameter>& only = {}) {
  const Eigen::VectorXd e = (loop.y.row(channel.cv) - loop.y_sim.row(channel.cv)).transpose();
  return fit_channel(study.plant.G(channel.cv, channel.mv), study.controller.sample_time, e,
                     loop.u.row(channel.mv).transpose(), point.u(channel.mv), study.aggregate.confidence,
                     only);
}

}  // namespace

std::optional<PromisedRepair> promised_repair(const Study& study, const OperatingPoint& point,
                                              const AssessedLoop& loop, const AssessmentRecord& said,
                                              const QpSolverFactory& factory) {
  const std::optional<Channel> channel = channel_to_repair(said);
  if (!channel)
    return std::nullopt;
  std::optional<MismatchParameter> only;
  if (const auto named = said.named_mismatch(); named && is_fitted_alone(named->parameter))
    only = named->parameter;
  PromisedRepair result{.channel = *channel,
                        .only = only,
                        .fit = fit_of(study, point, loop, *channel, only),
                        .now = {},
                        .predicted = {}};
  Study repaired = study;
  repaired.plant.G(channel->cv, channel->mv) = result.fit.channel;
  result.now = variances_of(study, promised(study, point, loop, factory));
  result.predicted = variances_of(study, promised(repaired, point, loop, factory));
  return result;
}

RepairedLoop repaired_loop(const Study& study, const OperatingPoint& point, const ExperimentDraw& draw,
                           const AssessedLoop& loop, const Channel& channel, const QpSolverFactory& factory) {
  if (study.simulation.excitation == SignalSequence::each)
    return repaired_loop(with_excitation(study, draw.index), point, draw, loop, channel, factory);
  RepairedLoop result{.channel = channel,
                      .fit = fit_of(study, point, loop, channel),
                      .now = {},
                      .predicted = {},
                      .repaired = {},
                      .perfect = {}};
  ExperimentDraw from_the_start = draw;
  from_the_start.onset = {};
  Study repaired = study;
  repaired.plant.G(channel.cv, channel.mv) = result.fit.channel;
  const auto variances_with = [&](const Study& controller, const ExperimentDraw& seen) {
    return variances_of(study, simulate_experiment(controller, seen, factory));
  };
  result.now = variances_with(study, from_the_start);
  result.predicted = variances_of(study, promised(repaired, point, loop, factory));
  if (study.nonlinear) {
    result.repaired = variances_with(repaired, from_the_start);
    result.perfect = variances_with(study, from_the_start.disturbance_alone());
    return result;
  }
  const TransferMatrix plant =
      with_world_mismatches(world_plant(study, draw_world(study, draw.world)), draw.mismatches);
  result.repaired = variances_with(repaired, against(repaired.plant.G, plant, from_the_start));
  Study perfect = study;
  perfect.plant.G = plant;
  result.perfect = variances_with(perfect, against(plant, plant, from_the_start));
  return result;
}

std::optional<Channel> channel_to_repair(const AssessmentRecord& said) {
  if (!said.answered() || !said.flagged)
    return std::nullopt;
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
