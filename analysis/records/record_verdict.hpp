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
  repair,       ///< this channel by that much
  sensor,       ///< look at the sensor of a CV,
  valve,        ///< at the valve of an MV,
  column,       ///< at the columns of the record,
  controller,   ///< at the controller of the study, which is not the one that ran,
  limit,        ///< at limits, tuning and the operating point, or
  disturbance,  ///< for what disturbs a CV
  test,         ///< move the MV of a channel, or all of them
  wait,
};
template <>
inline constexpr auto kWords<ActionKind> = word_list("nothing", "repair", "sensor", "valve", "column",
                                                     "controller", "limit", "disturbance", "test", "wait");

/// What counts as the plant's habit, and no fault.
enum class BenchmarkUse : std::int8_t {
  none,      ///< nothing, and nothing is proposed: the model does not fail, or nobody wants one
  named,     ///< a period that the study names
  found,     ///< the one in which the model is best, as the study wants it
  proposed,  ///< nothing; but in one period the model is best, and no channel is wrong in it
  unfit,     ///< nothing; in the best period a channel is wrong as well, or there is none
};
template <>
inline constexpr auto kWords<BenchmarkUse> = word_list("none", "named", "found", "proposed", "unfit");

/// The benchmark of a record. A period is proposed and never taken: what is wrong throughout the record would
/// be the plant's habit.
struct RecordBenchmark {
  BenchmarkUse use = BenchmarkUse::none;
  Eigen::Index first = 0, end = 0;  ///< samples of the period, in use or proposed; equal: there is none
  /// Of the best period, NoiseHabit::channel_score of the CV in which it is largest.
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
  bool has_setpoint = true;          ///< no: a range
  double now = 0.0, designed = 0.0;  ///< mean squares, CV unit squared
  double ratio = 1.0;                ///< of them: 1 as designed
  /// Above which simulated records without a fault hardly ever are, at least 1: what costs less than designed
  /// is no damage. NaN: unknown.
  double threshold = kNaN;

  bool is_dearer() const { return ratio > threshold; }
};

/// Samples of the record: the likeliest one from which on something is wrong, and its interval.
struct FaultOnset {
  Eigen::Index sample, earliest, latest;
};

/// What a repair is expected to take away of the cost of the loop, as shares of it.
struct PromisedGain {
  double gain, lower, upper;
  Eigen::VectorXd variance_ratio = {};  ///< ny, of each CV after the repair over before it; empty: not known
};

/// How often simulated records of which the same was said had what was said.
struct TrialCounts {
  std::int64_t healthy_above = 0, above = 0;  ///< score above the threshold: without a fault; all
  std::int64_t healthy_below = 0, below = 0;
  std::int64_t right = 0, same = 0;  ///< with the source that is named, of those of which it was named
};

/// All that the verdict rests on.
struct VerdictEvidence {
  /// Of model_check_method(), ny; NaN: nothing is known of the CV. Empty: it has no answer.
  Eigen::VectorXd model_scores;
  double model_threshold = kNaN;
  std::vector<UnexplainedPart> noisy = {};  ///< CVs whose noise is another
  double least_visible = 0.0;               ///< relative error of a gain that the record would show
  std::optional<TrialCounts> trials = {};   ///< none: there are no simulated records
  std::optional<FaultOnset> onset = {};
  std::vector<CvCost> costs = {};  ///< since the onset where there is one
  /// Posterior of the sources, given that there is one; need not sum to 1. It is `sensor_cv` that drifts.
  SourceWeights weights = {};
  bool jumps = false;  ///< it is a step
  /// Where `sensor_cv` shows one value that chance does not make: then its sensor has all of the weights.
  std::optional<Standstill> stuck = {};
  std::optional<NamedMismatch> mismatch = {};   ///< what is wrong with the model
  std::optional<NamedMismatch> likeliest = {};  ///< where no method names a mismatch; its size is not known
  Eigen::Index md = -1;  ///< whose channel the likeliest mismatch is of: none that can be repaired is named
  Eigen::Index valve_mv = -1, sensor_cv = -1;
  std::vector<Eigen::Index> late_cvs = {};  ///< of data; empty: all CVs
  double late = 0.0;  ///< samples by which they are late against the inputs, below 0: early
  bool late_is_corrected = false;
  std::optional<PromisedGain> promise = {};  ///< of the repair of its channel
  double worth = 0.1;       ///< gain from which on a channel is repaired that costs nothing (AdequacyOptions)
  bool tells_apart = true;  ///< the record tells the parameters of this channel apart
  bool controller_is_alike = true;
  RecordBenchmark benchmark = {};  ///< in use, or the best period, whose use the verdict decides
};

/// A repair that takes away less of what the loop costs gains nothing: 0 % in the text.
inline constexpr double kNoGain = 0.005;

/// The verdict. record_verdict() makes it, and nothing changes it.
struct RecordVerdict {
  struct Model {
    ModelAnswer answer = ModelAnswer::cannot_tell;
    std::vector<UnexplainedPart> at = {};   ///< dearer ones first, then by score
    double score = kNaN, threshold = kNaN;  ///< the largest of the CVs; NaN: there is none
    std::optional<FaultOnset> since = {};
    /// The most probable one of a model that fails; of a CV that drifts the more probable one of its two.
    RecordSource source = RecordSource::nothing;
    bool drifts = false;  ///< `sensor_cv` does, by its sensor or by a disturbance: the record cannot tell
    bool jumps = false;   ///< once, where it drifts or its sensor does
    std::optional<Standstill> stuck = {};  ///< of the source `sensor`: where `sensor_cv` shows one value
    std::optional<NamedMismatch> mismatch = {};   ///< of a source with a mismatch
    Eigen::Index md = -1;                         ///< of a mismatch that is of an MD
    Eigen::Index valve_mv = -1, sensor_cv = -1;   ///< of these sources, and of a drift
    std::vector<Eigen::Index> late_cvs = {};      ///< of data, or where it is corrected; empty: all CVs
    double late = 0.0;                            ///< samples, below 0: early; 0: none is
    bool late_is_corrected = false;               ///< the model was held against the record with it
    std::optional<OfSources> probabilities = {};  ///< sum to 1, each inside of 0 and 1; none: not known

    bool has_mismatch() const { return source == RecordSource::mismatch || source == RecordSource::both; }
  };
  struct Loop {
    LoopAnswer answer = LoopAnswer::cannot_tell;
    std::vector<CvCost> costs = {};  ///< the dearer ones first, and of those the largest ratio
  };
  struct Action {
    ActionKind kind = ActionKind::wait;
    std::optional<Channel> channel = {};  ///< of a repair, a test or one to leave alone
    Eigen::Index cv = -1, mv = -1;        ///< what to look at
    std::optional<PromisedGain> promise = {};
    std::vector<Eigen::Index> worsened = {};  ///< why a channel is tested and not repaired
  };

  Model model;
  Loop loop;
  Action action;
  RecordBenchmark benchmark;
  bool has_trials = false;
  bool controller_is_alike = true;

  /// The CV that is named: the first one that the model does not explain, or else the dearest one; -1: none.
  Eigen::Index named_cv() const;
  /// Of a dearer loop: is that the CV that costs most?
  bool names_dearest() const;
  /// Of docs/own_records.md: "fault", "other_controller", "unexplained_cost", "nothing"; "none" where neither
  /// question has an answer.
  const char* found() const;
};

/// The verdict that the evidence leads to, and the only place where anything is decided:
///
/// - The model fails where the score of a CV is above the threshold, or its noise is another; it cannot tell
///   where no CV has a score, or no gain that is wrong by half would show.
/// - A CV is dearer where its ratio is above its threshold, and above 1.
/// - P(nothing) is that of simulated records on the same side of the threshold, (healthy + 1) / (all + 2).
///   The rest falls on the other sources by their posterior q, held back by c = (right + 1) / (same + 2):
///
///     P(s) = (1 - P(nothing)) (c q(s) + (1 - c) / 7)
///
/// - A CV drifts where both causes of a drift together are the most probable source.
/// - Of a model that fails without a benchmark the best period is proposed as one, unless the score of a
///   channel in it is above the threshold.
/// - The action follows from both answers and the source.
RecordVerdict record_verdict(const VerdictEvidence& evidence);

}  // namespace mpm
