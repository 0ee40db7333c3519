#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/told_source.hpp"

namespace mpm {

/// How the assessment of a loop ended.
enum class AssessmentStatus : std::int8_t {
  ok = 0,
  not_applicable = 1,  ///< the loop lacks what the method needs (Assessment::reason)
  failed = 2,          ///< the data gave no answer: a singular covariance, no usable model, ...
  not_assessed = 3,    ///< the method was not asked: the loop did not run to its end, or was left out
};

template <>
inline constexpr auto kWords<AssessmentStatus> = word_list("ok", "not applicable", "failed", "not assessed");

/// The verdict of a method on one CV.
struct CvAssessment {
  /// Whether the model or the performance of this CV is faulty; none if the method has no verdict on it.
  std::optional<bool> flagged = {};
  /// How far the CV is from being flagged: larger is worse. It is comparable between the CVs and loops of one
  /// method. NaN if `flagged` is none.
  double score = kNaN;
  /// mpm or ud, for a flagged CV or the worst one, from methods that tell sources apart; otherwise none.
  FaultSource source = FaultSource::none;
  ToldSource about = ToldSource::other;  ///< place of the fault for the source `other`, if it is known
};

/// A channel of the model, CV against MV.
struct Channel {
  Eigen::Index cv;
  Eigen::Index mv;

  friend bool operator==(const Channel&, const Channel&) = default;
};

/// Where an estimate lies in the range of its search. At an end of the range it is only a bound: the true
/// value may lie beyond that end.
enum class SizeBound : std::int8_t { none = 0, at_most = 1, at_least = 2 };

template <>
inline constexpr auto kWords<SizeBound> = word_list("none", "at most", "at least");

/// Classifies an estimate: a bound if it lies within `share` of the range from one of its ends.
SizeBound bound_within(double estimate, double first, double last, double share = 1e-6);

/// The mismatch of which a method is most certain: parameter, channel and size.
struct NamedMismatch {
  Channel channel;
  MismatchParameter parameter;
  double size = kNaN;                 ///< as Mismatch::value; NaN: the method gives no size
  double lower = kNaN, upper = kNaN;  ///< interval with the confidence aggregate.confidence; NaN: none
  SizeBound bound = SizeBound::none;  ///< tells if the size lies at an end of the searched range

  /// Does the interval hold `value`? It is open at an end at which the size is only a bound.
  bool holds(double value) const;
};

/// One number of a method, by a name of MethodDescription::numbers. It belongs to the whole loop (cv and
/// column -1), to a CV (column -1), to a channel (its MV in `column`), or to a CV at a lag (the lag in
/// `column`).
struct AssessmentNumber {
  std::string name;
  double value;
  Eigen::Index cv = -1;
  Eigen::Index column = -1;
};

/// The verdict of a method on one loop.
struct Assessment {
  AssessmentStatus status = AssessmentStatus::ok;
  std::string reason;  ///< one sentence for people if the status is not ok

  bool flagged = false;  ///< the loop has a fault: the verdict that counts as a detection
  /// Score of the loop; larger is worse. ROC curves are drawn over it. It need not be the score of a CV.
  double score = kNaN;
  std::vector<CvAssessment> cvs;                     ///< ny; empty if the method does not judge single CVs
  std::vector<Channel> flagged_channels;             ///< from methods that name channels
  std::optional<NamedMismatch> named_mismatch = {};  ///< from methods that name mismatches; may be none
  /// From methods that name candidates: position of the logged signal that drives the disturbance; none if
  /// none is named.
  std::optional<Eigen::Index> named_candidate = {};
  std::vector<AssessmentNumber> numbers;

  /// The CV with the largest score; none if no CV has a score.
  std::optional<Eigen::Index> worst_cv() const;
  /// The number of this name, CV and column; NaN if there is none.
  double number(std::string_view name, Eigen::Index cv = -1, Eigen::Index column = -1) const;

  static Assessment not_applicable(std::string reason);
  static Assessment failed(std::string reason);
};

}  // namespace mpm
