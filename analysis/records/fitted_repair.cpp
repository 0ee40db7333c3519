#include "analysis/records/fitted_repair.hpp"

#include <algorithm>
#include <vector>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/cv_evidence.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/records/untold_part.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// An onset is searched for in its interval and as far to either side as the interval is long, at least
/// kLeastRoom samples. A growth may take a kGrowingPart-th of the record, and half of it may pass unnoticed
/// before the interval.
constexpr Eigen::Index kLeastRoom = 5;
constexpr Eigen::Index kGrowingPart = 3;
/// A plant's disturbances are no autoregression, and its controller reacts to them. Under the seeds 84 and
/// 101 of tests/reliability/records.py 88 % of 124 intervals of 95 % held the size; scaled by this factor 96
/// % do.
constexpr double kWidening = 1.25;

FitSurroundings::Onset onset_range(const FaultOnset& since, Eigen::Index samples) {
  const Eigen::Index room = std::max(kLeastRoom, since.latest - since.earliest);
  const Eigen::Index before = std::max(room, samples / kGrowingPart / 2);
  return {std::max<Eigen::Index>(0, since.earliest - before), std::min(samples - 1, since.latest + room),
          samples / kGrowingPart};
}

/// The range of an onset that nobody could tell: perhaps the fault was there from the start. A channel needs
/// at least a fifth of the record to show.
FitSurroundings::Onset anywhere(Eigen::Index samples) {
  return {0, samples - samples / 5, samples / kGrowingPart};
}

double size_of(const ChannelRepair& repair, MismatchParameter parameter) {
  return parameter == MismatchParameter::gain            ? repair.gain_factor.value
         : parameter == MismatchParameter::time_constant ? repair.time_factor.value
                                                         : repair.dead_time_shift.value;
}

}  // namespace

ChannelRepair fitted_repair(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                            const Channel& channel, const std::optional<MismatchParameter>& only,
                            double delta, const std::optional<FaultOnset>& since) {
  ModelErrorPrior prior = relative_errors(study, channel.cv, delta, 0.0);
  std::erase_if(prior.channels, [&](const ChannelError& error) {
    return error.input == channel.mv && (!only || error.parameter == *only);
  });
  const Eigen::MatrixXd inputs = model_inputs(loop.from_start());
  const Eigen::VectorXd initial = inputs.col(0);  // the inputs before the record are not known
  const ModelErrors errors(study, channel.cv, prior, Eigen::RowVectorXd::Constant(1, kNaN),
                           Eigen::MatrixXd::Zero(inputs.rows(), 1), initial, 1.0, BaseNoise{1.0});
  const Eigen::RowVectorXd e = loop.y.row(channel.cv) - loop.y_sim.row(channel.cv);
  const Eigen::MatrixXd untold = untold_columns(
      study, channel.cv, starts_after_unknown(loop.y, slowest_settling(study)), loop.samples());
  const Eigen::MatrixXd nominal = errors.slopes(inputs, initial);
  FitSurroundings beside{.onset = since ? onset_range(*since, loop.samples()) : anywhere(loop.samples()),
                         .widening = kWidening};
  const auto fitted_beside = [&](const Eigen::MatrixXd& slopes) {
    beside.unknown.resize(slopes.rows() + untold.cols() - 1, loop.samples());
    beside.unknown << slopes.middleCols(loop.first, loop.samples()),
        CvLikelihood::kUntold * deviation_of_steps(e) *
            untold.rightCols(untold.cols() - 1).transpose();  // a constant is free
    return identified_channel(study, point, loop, channel, only, beside);
  };
  beside.asks_intervals = !only;
  ChannelRepair first = fitted_beside(nominal);
  if (!only)
    return first;
  // The other parameters of the channel act on the channel as it is, not as the model has it.
  beside.asks_intervals = true;
  return fitted_beside(
      errors.slopes(nominal, {0, channel.mv, *only, size_of(first, *only)}, inputs, initial));
}

}  // namespace mpm
