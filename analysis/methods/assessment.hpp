#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "plants/non_finite.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {

/// How the assessment of a loop ended.
enum class AssessmentStatus : std::int8_t {
  ok = 0,
  not_applicable = 1,  ///< the method needs what this loop does not have (Assessment::reason)
  failed = 2,          ///< the data gave no answer: a singular covariance, no usable model, ...
  not_assessed = 3,    ///< nobody asked the method: the loop did not run to its end, or was left out
};

/// "ok", "not applicable", "failed", "not assessed"
std::string_view to_string(AssessmentStatus status);

/// What a method says of one CV.
struct CvAssessment {
  /// The model of this CV, or its performance, is not as it should be; none: the method says nothing of it.
  std::optional<bool> flagged = {};
  /// How far the CV is from being flagged: larger is worse, comparable between CVs and loops of one method;
  /// NaN where `flagged` is none.
  double score = kNaN;
  /// By methods that tell sources apart, of a flagged CV or the worst one: mpm or ud; otherwise none.
  FaultSource source = FaultSource::none;
};

/// A channel of the model, CV against MV.
struct Channel {
  Eigen::Index cv;
  Eigen::Index mv;

  friend bool operator==(const Channel&, const Channel&) = default;
};

/// Where an estimate lies in the range in which it was looked for. At an end of it the estimate is no more
/// than a bound: what is looked for may lie beyond.
enum class SizeBound : std::int8_t { none = 0, at_most = 1, at_least = 2 };

/// "none", "at most", "at least"
std::string_view to_string(SizeBound bound);

/// The bound that an estimate is in a range whose ends are ends of the search only: it is one within `share`
/// of the range.
SizeBound bound_within(double estimate, double first, double last, double share = 1e-6);

/// The mismatch that a method is surest of: which parameter of which channel, and how large.
struct NamedMismatch {
  Channel channel;
  MismatchParameter parameter;
  double size = kNaN;                 ///< as Mismatch::value; NaN: the method gives no size
  double lower = kNaN, upper = kNaN;  ///< its interval, of the confidence aggregate.confidence; NaN: none
  SizeBound bound = SizeBound::none;  ///< the size lies at an end of the range that was searched
};

/// One number of a method, by a name of MethodDescription::numbers. Of the whole loop (cv and column -1), of
/// a CV (column -1), of a channel (its MV in `column`) or of a CV at a lag (the lag in `column`).
struct AssessmentNumber {
  std::string name;
  double value;
  Eigen::Index cv = -1;
  Eigen::Index column = -1;
};

/// What a method of assessment says of one loop.
struct Assessment {
  AssessmentStatus status = AssessmentStatus::ok;
  std::string reason;  ///< one sentence for people when the status is not ok

  bool flagged = false;  ///< something is wrong with the loop: the verdict that is counted as a detection
  /// How far the loop is from being flagged, larger is worse: what a ROC curve is drawn over. It need not be
  /// that of a CV.
  double score = kNaN;
  std::vector<CvAssessment> cvs;                     ///< ny; empty when the method does not look at CVs alone
  std::vector<Channel> flagged_channels;             ///< of methods that name channels
  std::optional<NamedMismatch> named_mismatch = {};  ///< of methods that name mismatches; none: none is named
  /// Of methods that name candidates: position of the logged signal that drives the disturbance; none: none
  /// is named.
  std::optional<Eigen::Index> named_candidate = {};
  std::vector<AssessmentNumber> numbers;

  /// The CV with the largest score; none without one.
  std::optional<Eigen::Index> worst_cv() const;
  /// The number of this name, CV and column; NaN when there is none.
  double number(std::string_view name, Eigen::Index cv = -1, Eigen::Index column = -1) const;

  static Assessment not_applicable(std::string reason);
  static Assessment failed(std::string reason);
};

}  // namespace mpm
