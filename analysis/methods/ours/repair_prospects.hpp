#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "plants/linear/transfer_function.hpp"
#include "scenarios/random/random_stream.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/for_each_with_solver.hpp"

// The expected gain of the repair of each channel, from the record alone.

namespace mpm {

/// Options of the method `adequacy`, and of all code that ranks repairs.
struct AdequacyOptions {
  double worth = 0.1;        ///< gain of a repair below which the model is adequate
  double probability = 0.5;  ///< of a gain above `worth`, from which on the model is not adequate
  double deviation = 0.3;    ///< of the relative errors of the model before the record is seen
  int draws = 8;
  int channels = 4;

  bool operator==(const AdequacyOptions&) const = default;
};

/// A variance counts as better or worse if it changes by more than this factor.
inline constexpr double kNoticeableChange = 1.05;

/// The channel of the model after its repair.
struct RepairedChannel {
  Channel channel;
  TransferFunction model;  ///< without washout
};

/// The gain of one repair on the plants that the record leaves possible.
struct RepairProspect {
  RepairedChannel repair;
  std::vector<double> gains;  ///< ascending, of the plants on which all loops run to their end; may be empty
  /// ny: mean variance of a CV on these plants after the repair over that before it; if only some samples
  /// count, its counted_costs() take the place of the variance.
  Eigen::VectorXd variance_ratio = {};

  /// The expected gain; NaN without a plant.
  double gain() const;
  /// Share of the plants on which the gain is larger; NaN without a plant.
  double probability_above(double worth) const;
  /// Whether it is expected to gain something, and to worsen no CV noticeably.
  bool is_proposed() const;
};

/// The prospects of the channels of a study. The record gives the errors of gain, time constant and dead time
/// of every channel a posterior (ModelErrors, prior of AdequacyOptions::deviation), disturbances and noise
/// integrated out. With P a plant drawn from it, n what P leaves of the record and J the cost of a loop
/// (LoopCost::total()),
///
///   gain(i, j) = (J(G0) - J(G0 with the repaired channel (i, j))) / J(G0)
///
/// of the loops of plant P under n, with the controller on either model. A channel is repaired to its
/// posterior mean, except for one whose repair is `given`. Plants whose loop costs much more than the record
/// do not count.
class RepairProspects {
 public:
  /// `study`, which has the options, must outlive it. `for_each` runs the loops, those of each plant
  /// together.
  RepairProspects(const Study& study, const OperatingPoint& point, ForEachWithSolver for_each);

  /// The prospects of the given channel and of those whose errors explain most of their CV, in this order;
  /// none if a CV has too few samples. Simulates 1 + channels closed loops for each draw. `counted` marks the
  /// samples at which loops cost something; empty: all.
  std::optional<std::vector<RepairProspect>> of(const AssessedLoop& loop,
                                                const std::optional<RepairedChannel>& given = {},
                                                const std::vector<bool>& counted = {}) const;

 private:
  struct Seen;
  struct Outcome;
  struct DrawnPlant;

  std::vector<RepairProspect> candidates(const Seen& seen, const std::optional<RepairedChannel>& given) const;
  void run(const Seen& seen, std::vector<RepairProspect>& prospects) const;
  DrawnPlant drawn(const Seen& seen, RandomStream& random) const;
  /// The loop as it is, and then after each repair; empty on a plant that does not count.
  std::vector<std::optional<Outcome>> outcomes(const Seen& seen, const DrawnPlant& drawn,
                                               const std::vector<RepairProspect>& prospects,
                                               const QpSolverFactory& factory) const;
  Eigen::RowVectorXd response(const Seen& seen, const TransferFunction& channel, Eigen::Index input) const;
  /// Whether the loop of a drawn plant resembles the record. This is asked only if samples are counted, as in
  /// the record of a plant: there the controller of the study may be unstable on a plant on which that of the
  /// record is stable.
  bool may_have_made(const Seen& seen, const Outcome& now) const;
  std::optional<Outcome> outcome(const TransferMatrix& model, const TransferMatrix& plant, const Seen& seen,
                                 const Eigen::MatrixXd& disturbance, const QpSolverFactory& factory) const;

  const Study& study_;
  const AdequacyOptions& options_;
  Eigen::VectorXd initial_;  ///< inputs before the record
  ForEachWithSolver for_each_;
};

/// Sorts by expected gain, the largest first; those that ran on no plant come last.
std::vector<RepairProspect> ranked(std::vector<RepairProspect> prospects);

/// The prospect of this channel; null if it ran on no plant.
const RepairProspect* prospect_of(const std::vector<RepairProspect>& prospects, const Channel& channel);

}  // namespace mpm
