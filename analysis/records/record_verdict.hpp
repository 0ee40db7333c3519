#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment.hpp"
#include "analysis/methods/ours/record_source.hpp"
#include "analysis/methods/ours/source_weights.hpp"
#include "analysis/statistics/standstill.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

// The verdict on a record of a plant: three questions, three answers, one value. Text, page, JSON and Python
// show this value and decide nothing.

namespace mpm {

/// Does the model still explain the record?
enum class ModelAnswer : std::int8_t { explains, fails, cannot_tell };
template <>
inline constexpr auto kWords<ModelAnswer> = word_list("explains", "fails", "cannot_tell");

/// What does the loop cost against the loop as designed?
enum class LoopAnswer : std::int8_t { as_designed, dearer, cannot_tell };
template <>
inline constexpr auto kWords<LoopAnswer> = word_list("as_designed", "dearer", "cannot_tell");

enum class ActionKind : std::int8_t {
  nothing,
  repair,       ///< correct this channel by that much
  sensor,       ///< look at the sensor of a CV
  valve,        ///< look at the valve of an MV
  column,       ///< look at the columns of the record
  controller,   ///< look at the controller of the study, which is not the one that ran
  limit,        ///< look at limits, tuning and the operating point
  disturbance,  ///< look for the cause that disturbs a CV
  test,         ///< move the MV of a channel, or all MVs
  wait,
};
template <>
inline constexpr auto kWords<ActionKind> = word_list("nothing", "repair", "sensor", "valve", "column",
                                                     "controller", "limit", "disturbance", "test", "wait");

/// What counts as the plant's habit, not as a fault.
enum class BenchmarkUse : std::int8_t {
  none,      ///< no period, and none is proposed: the model does not fail, or nobody wants a benchmark
  named,     ///< a period that the study names
  found,     ///< the period in which the model is best, as the study asks
  proposed,  ///< no period yet; the one in which the model is best is proposed, and no channel is wrong in it
  unfit,     ///< no period; a channel is wrong in the best one as well, or there is no best one
};
template <>
inline constexpr auto kWords<BenchmarkUse> = word_list("none", "named", "found", "proposed", "unfit");

/// The benchmark of a record. A period is only proposed, never taken: what is wrong throughout the record
/// would otherwise become the plant's habit.
struct RecordBenchmark {
  BenchmarkUse use = BenchmarkUse::none;
  Eigen::Index first = 0, end = 0;  ///< samples of the period, in use or proposed; equal: there is none
  /// The largest NoiseHabit::channel_score of a CV in the best period, and that CV.
  double channel_score = kNaN;
  Eigen::Index cv = -1;
  bool is_wanted = true;  ///< data.benchmark is not "none"
};

/// A CV that the model does not explain: `score` is above `threshold`.
struct UnexplainedPart {
  Eigen::Index cv;
  double score, threshold;
  /// The score is the noise of the CV over that of the study (UnexplainedCv), not that of
  /// model_check_method().
  bool is_noise = false;
};

/// What a CV costs its controller, by cost_of_record().
struct CvCost {
  Eigen::Index cv = 0;
  bool has_setpoint = true;          ///< false: it has a range
  double now = 0.0, designed = 0.0;  ///< mean squares, CV unit squared
  double ratio = 1.0;                ///< of both, by cost_of_record(); 1: as designed
  /// Simulated records without a fault hardly ever have a ratio above this. It is at least 1, because a CV
  /// that costs less than designed does no damage. NaN: unknown.
  double threshold = kNaN;

  bool is_dearer() const { return ratio > threshold; }
};

/// Since when something is wrong, in samples of the record: the likeliest onset and its interval.
struct FaultOnset {
  Eigen::Index sample, earliest, latest;
};

/// What a repair is expected to take off the cost of the loop, as shares of this cost.
struct PromisedGain {
  double gain, lower, upper;
  /// Variance of each CV (ny) after the repair over that before; empty: not known.
  Eigen::VectorXd variance_ratio = {};
};

/// How often the same answer was right on simulated records.
struct TrialCounts {
  /// Records with a score above the threshold: those without a fault, and all.
  std::int64_t healthy_above = 0, above = 0;
  std::int64_t healthy_below = 0, below = 0;
  /// Records for which the same source is named: those that have it, and all.
  std::int64_t right = 0, same = 0;
};

/// All that the verdict rests on.
struct VerdictEvidence {
  /// Scores of model_check_method(), ny; NaN: nothing is known about the CV. Empty: the method has no answer.
  Eigen::VectorXd model_scores;
  double model_threshold = kNaN;
  std::vector<UnexplainedPart> noisy = {};  ///< CVs whose noise differs from the study's
  double least_visible = 0.0;               ///< smallest relative error of a gain that the record would show
  std::optional<TrialCounts> trials = {};   ///< none: there are no simulated records
  std::optional<FaultOnset> onset = {};
  std::vector<CvCost> costs = {};  ///< since the onset if there is one
  /// Posterior of the sources, given that there is a fault; need not sum to 1. If something drifts, it is
  /// `sensor_cv`.
  SourceWeights weights = {};
  bool jumps = false;  ///< the sensor of `sensor_cv` jumps
  /// Where `sensor_cv` shows one value for longer than chance explains; its sensor then has all of the
  /// weight.
  std::optional<Standstill> stuck = {};
  std::optional<NamedMismatch> mismatch = {};   ///< what is wrong with the model
  std::optional<NamedMismatch> likeliest = {};  ///< if no method names a mismatch; its size is not known
  Eigen::Index md = -1;  ///< MD whose channel has the likeliest mismatch; then no channel is repaired
  Eigen::Index valve_mv = -1, sensor_cv = -1;
  std::vector<Eigen::Index> late_cvs = {};  ///< CVs that are late if the source is data; empty: all CVs
  double late = 0.0;  ///< samples by which they are late against the inputs, below 0: early
  bool late_is_corrected = false;
  std::optional<PromisedGain> promise = {};  ///< of the repair of the channel of `mismatch`
  /// Gain from which on a channel is repaired although the loop is not dearer (AdequacyOptions).
  double worth = 0.1;
  bool tells_apart = true;  ///< the record tells the parameters of this channel apart
  bool controller_is_alike = true;
  RecordBenchmark benchmark = {};  ///< in use, or the best period, whose use the verdict decides
};

/// A repair that takes a smaller share off the cost of the loop gains nothing: 0 % in the text.
inline constexpr double kNoGain = 0.005;

/// The verdict. record_verdict() makes it, and nothing changes it.
struct RecordVerdict {
  struct Model {
    ModelAnswer answer = ModelAnswer::cannot_tell;
    std::vector<UnexplainedPart> at = {};   ///< dearer ones first, then by score
    double score = kNaN, threshold = kNaN;  ///< the largest of the CVs; NaN: there is none
    std::optional<FaultOnset> since = {};
    /// The most probable source if the model fails. If a CV drifts, the more probable one of its two causes.
    RecordSource source = RecordSource::nothing;
    bool drifts = false;  ///< `sensor_cv` drifts, by its sensor or by a disturbance: the record cannot tell
    bool jumps = false;   ///< `sensor_cv` or its sensor jumps once
    std::optional<Standstill> stuck = {};  ///< where `sensor_cv` shows one value, if the source is `sensor`
    std::optional<NamedMismatch> mismatch = {};  ///< if the source has a mismatch
    Eigen::Index md = -1;                        ///< MD of the channel with the mismatch; -1: none
    Eigen::Index valve_mv = -1, sensor_cv = -1;  ///< if the source is one of these, or a CV drifts
    /// Late CVs, if the source is data or lateness is corrected; empty: all CVs.
    std::vector<Eigen::Index> late_cvs = {};
    double late = 0.0;               ///< samples by which they are late, below 0: early; 0: none is late
    bool late_is_corrected = false;  ///< the model was compared with the record after this correction
    std::optional<OfSources> probabilities = {};  ///< sum to 1, each between 0 and 1; none: not known

    bool has_mismatch() const { return source == RecordSource::mismatch || source == RecordSource::both; }
  };
  struct Loop {
    LoopAnswer answer = LoopAnswer::cannot_tell;
    std::vector<CvCost> costs = {};  ///< the dearer ones first, then by falling ratio
  };
  struct Action {
    ActionKind kind = ActionKind::wait;
    std::optional<Channel> channel = {};  ///< to repair, to test or to leave alone
    Eigen::Index cv = -1, mv = -1;        ///< what to look at
    std::optional<PromisedGain> promise = {};
    /// CVs that its repair would make worse: the channel is tested instead.
    std::vector<Eigen::Index> worsened = {};
  };

  Model model;
  Loop loop;
  Action action;
  RecordBenchmark benchmark;
  bool has_trials = false;
  bool controller_is_alike = true;

  /// The CV that is named: the first one that the model does not explain, or else the dearest one; -1: none.
  Eigen::Index named_cv() const;
  /// Returns whether the named CV is the one that costs most; true if the loop is not dearer.
  bool names_dearest() const;
  /// The word of docs/own_records.md for what was found: "fault", "other_controller", "unexplained_cost",
  /// "nothing"; "none" if neither question has an answer.
  const char* found() const;
};

/// The verdict that the evidence leads to, and the only place where anything is decided:
///
/// - The model fails if the score of a CV is above the threshold, or if its noise differs from the study's.
///   The record cannot tell if no CV has a score, or if no gain that is wrong by half would show.
/// - A CV is dearer if its ratio is above its threshold, and above 1.
/// - P(nothing) is the share of healthy ones among the simulated records on the same side of the threshold,
///   (healthy + 1) / (all + 2). The other sources share the rest by their posterior q, as far as such answers
///   are right, c = (right + 1) / (same + 2):
///
///     P(s) = (1 - P(nothing)) (c q(s) + (1 - c) / 7)
///
/// - A CV drifts if both causes of a drift together are the most probable source.
/// - If the model fails without a benchmark, the best period is proposed as one, unless the score of a
///   channel in it is above the threshold.
/// - The action follows from both answers and the source.
RecordVerdict record_verdict(const VerdictEvidence& evidence);

}  // namespace mpm
