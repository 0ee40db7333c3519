#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/experiment.hpp"
#include "analysis/methods/channel_fit.hpp"

// What an engineer does with a named channel: identify it again, and put it into the controller.

namespace mpm {

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
/// `predicted` is all that is known in a plant: its errors are what the repaired model leaves of the record.
/// Of a nonlinear plant `perfect` is the controller of the study on the plant without its mismatches.
/// A vector is empty when its loop did not run to its end.
struct RepairedLoop {
  Channel channel;
  ChannelFit fit;
  Eigen::VectorXd now, predicted, repaired, perfect;

  /// All loops of the comparison ran to their end.
  bool compares() const { return now.size() > 0 && repaired.size() > 0 && perfect.size() > 0; }
  /// Mean over the CVs of a variance over that of the perfect controller: 1 is as good as can be.
  double loss_now() const { return (now.array() / perfect.array()).mean(); }
  double loss_repaired() const { return (repaired.array() / perfect.array()).mean(); }
};

/// Repairs the channel of the model of `study` by the record `loop` of the experiment `draw`
/// (assessed_loop()), and runs the loops. Throws InputError as fit_channel().
RepairedLoop repaired_loop(const Study& study, const OperatingPoint& point, const ExperimentDraw& draw,
                           const AssessedLoop& loop, const Channel& channel, const QpSolverFactory& factory);

/// What a repaired channel promises from a record alone, all that is known in a plant: variances of the CVs
/// as RepairedLoop has them, with the errors of the record under the model of the study (`now`) and under the
/// repaired one (`predicted`).
struct PromisedRepair {
  Channel channel;
  std::optional<MismatchParameter> only;  ///< that was identified again; none: the whole channel
  ChannelFit fit;
  Eigen::VectorXd now, predicted;
};

/// The repair that the method's answer asks for: of the parameter that it names, or of the whole channel
/// where it names none. None where it names no channel. Throws InputError as fit_channel().
std::optional<PromisedRepair> promised_repair(const Study& study, const OperatingPoint& point,
                                              const AssessedLoop& loop, const AssessmentRecord& said,
                                              const QpSolverFactory& factory);

/// The channel that the method would have repaired: that of the mismatch it names, or of a method that names
/// none the first channel that it flags. None of a loop that it does not flag.
std::optional<Channel> channel_to_repair(const AssessmentRecord& said);

/// The same, whether it flags the loop or not.
std::optional<Channel> named_channel(const AssessmentRecord& said);

}  // namespace mpm
