#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/ours/channel_fit.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "scenarios/loop/experiment_draw.hpp"

// An engineer corrects a named channel and puts it into the controller.

namespace mpm {

/// How a channel of the model is corrected. If a method names the size of a mismatch with its interval, this
/// size goes into the model: verdict and repair share one estimate. Otherwise the channel is identified again
/// (fit_channel()): only the parameter that the method names, or all parameters.
struct ChannelRepair {
  Channel channel;
  std::optional<NamedMismatch> named;          ///< whose size is the correction; none: identified again
  std::optional<MismatchParameter> parameter;  ///< the only one to change; none: the whole channel
  FittedNumber gain_factor, time_factor, dead_time_shift;  ///< relative to the model
  double explained = kNaN;  ///< ChannelFit::explained; NaN for a size that a method names
  TransferFunction model;   ///< the corrected model of the channel

  RepairedChannel repaired() const { return {channel, model}; }
};

/// Identifies a channel again from the record. Throws InputError as fit_channel().
ChannelRepair identified_channel(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                                 const Channel& channel, const std::optional<MismatchParameter>& only = {},
                                 const FitSurroundings& beside = {});

/// The repair that follows from the answer of a method; none if it names no channel or does not flag the
/// loop. Throws InputError as fit_channel().
std::optional<ChannelRepair> channel_repair(const Study& study, const OperatingPoint& point,
                                            const AssessedLoop& loop, const AssessmentRecord& said);

/// The variances of the CVs of a loop whose controller has a model that was repaired in one channel, ny each:
/// about the setpoint of a CV that has one, about the mean otherwise. All loops have the noise, the
/// excitation and the faults of the experiment, from the first sample on.
///
/// | member    | model of the controller  | plant                                            |
/// |-----------|--------------------------|--------------------------------------------------|
/// | now       | that of the study        | that of the experiment                           |
/// | predicted | the repaired one         | the repaired model, errors of the record added   |
/// | repaired  | the repaired one         | that of the experiment                           |
/// | perfect   | the plant                | that of the experiment                           |
///
/// `predicted` is all that can be known in a real plant: its errors are those that the repaired model leaves
/// in the record. For a nonlinear plant, `perfect` is the controller of the study on the plant without its
/// mismatches. A vector is empty if its loop did not run to its end.
struct RepairedLoop {
  ChannelRepair repair;
  Eigen::VectorXd now, predicted, repaired, perfect;

  /// All loops of the comparison ran to their end.
  bool compares() const { return now.size() > 0 && repaired.size() > 0 && perfect.size() > 0; }
  /// Mean over the CVs of the variance relative to that with the perfect controller: 1 is as good as can be.
  double loss_now() const { return (now.array() / perfect.array()).mean(); }
  double loss_repaired() const { return (repaired.array() / perfect.array()).mean(); }
};

/// Runs the loops of the experiment `draw`, whose record is `loop` (assessed_loop()).
RepairedLoop repaired_loop(const Study& study, const OperatingPoint& point, const ExperimentDraw& draw,
                           const AssessedLoop& loop, const ChannelRepair& repair,
                           const QpSolverFactory& factory);

/// The gain of a repaired channel that a record alone predicts, as in a real plant: variances of the CVs as
/// in RepairedLoop, with the errors of the record under the model of the study (`now`) and under the repaired
/// model (`predicted`). If only some samples count, they are counted_costs() instead: the cost of a CV in its
/// controller, over these samples.
struct PromisedRepair {
  ChannelRepair repair;
  Eigen::VectorXd now, predicted;
};

PromisedRepair promised_repair(const Study& study, const OperatingPoint& point, const AssessedLoop& loop,
                               const ChannelRepair& repair, const QpSolverFactory& factory,
                               const std::vector<bool>& counted = {});

/// The channel that the method would have repaired: the channel of the mismatch that it names or, if it names
/// none, the first channel that it flags. None if it does not flag the loop.
std::optional<Channel> channel_to_repair(const AssessmentRecord& said);

/// The same, whether it flags the loop or not.
std::optional<Channel> named_channel(const AssessmentRecord& said);

}  // namespace mpm
