#include "analysis/experiment/repair.hpp"

#include "analysis/experiment/repaired_model.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

Eigen::VectorXd variances_of(const Study& study, const Trajectory& loop) {
  if (loop.status != ControlStatus::ok)
    return {};
  return variances(loop.y, variance_centres(study, 0, loop.y.cols()));
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

ChannelFit fit_of(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                  const Channel& channel, const std::optional<MismatchParameter>& only = {}) {
  const Eigen::VectorXd e = (loop.y.row(channel.cv) - loop.y_sim.row(channel.cv)).transpose();
  ChannelFit fit =
      fit_channel(study.assessed_channel(channel.cv, channel.mv), study.controller.sample_time, e,
                  loop.u.row(channel.mv).transpose(), point.u(channel.mv), study.aggregate.confidence, only);
  fit.channel = fit.channel.without_washout();
  return fit;
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
  TransferMatrix repaired = study.plant.G;
  repaired(channel.cv, channel.mv) = result.fit.channel;
  Study with_repair = study;
  with_repair.plant.G = repaired;
  const auto variances_with = [&](const TransferMatrix& model, const ExperimentDraw& seen) {
    return variances_of(study, loop_with_model(study, model, seen, factory));
  };
  result.now = variances_with(study.plant.G, draw);
  result.predicted = variances_of(study, promised(with_repair, point, loop, factory));
  result.repaired = variances_with(repaired, draw);
  result.perfect = study.nonlinear ? variances_with(study.plant.G, draw.disturbance_alone())
                                   : variances_with(true_plant(study, draw), draw);
  return result;
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
