#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "base/non_finite.hpp"
#include "scenarios/study/study.hpp"

// The answers of methods in the form in which they are kept for all loops of a study: a vector of numbers for
// each loop, and for each method a form that says where each number stands in the vector.

namespace mpm {

/// The place of one number of a method in AssessmentRecord::numbers: rows x columns of them, row by row.
///
/// | scope   | rows | columns      |
/// |---------|------|--------------|
/// | loop    | 1    | 1            |
/// | cv      | ny   | 1            |
/// | channel | ny   | nu           |
/// | cv_lag  | ny   | lags         |
/// | window  | 1    | windows of study.monitoring |
struct NumberPlace {
  AssessmentNumberInfo info;
  Eigen::Index first, rows, columns;

  Eigen::Index size() const { return rows * columns; }
};

/// The form of the answers of one method on the loops of one study. First come the numbers that follow from
/// what the method answers (table), then its own numbers. If the study monitors, `window_flagged` (1, 0; NaN:
/// no verdict) and `window_score` come last.
///
/// | name            | scope   | of methods that |
/// |-----------------|---------|-----------------|
/// | cv_flagged      | cv      | locate CVs: 1 flagged, 0 not; NaN: no verdict on it |
/// | cv_score        | cv      | locate CVs: CvAssessment::score                          |
/// | cv_source       | cv      | tell sources: FaultSource of a flagged CV or the worst one |
/// | channel_flagged | channel | name channels: 1 for a named channel, 0 for others         |
/// | mismatch_parameter | channel | name mismatches: parameter of named_mismatch, at its channel |
/// | mismatch_size, mismatch_lower, mismatch_upper | channel | the same: its size and interval  |
/// | named_candidate | loop    | name candidates: Assessment::named_candidate; NaN: none           |
class AssessmentForm {
 public:
  AssessmentForm(MethodDescription method, const Study& study);

  /// The description of the method, without the numbers that follow from its verdicts.
  const MethodDescription& method() const { return method_; }
  const std::vector<NumberPlace>& places() const { return places_; }
  /// The count of all numbers.
  Eigen::Index size() const { return size_; }
  /// The place of the number of this name; null if there is none.
  const NumberPlace* find(std::string_view name) const;

 private:
  void add(AssessmentNumberInfo info, const Study& study);

  MethodDescription method_;
  std::vector<NumberPlace> places_;
  Eigen::Index size_ = 0;
};

/// The number of lags of numbers with the scope cv_lag: 0 ... a quarter of the record, as in
/// AcfComparisonOptions.
Eigen::Index lag_count(const Study& study);

/// The forms of several methods, in their order.
using AssessmentForms = std::vector<std::shared_ptr<const AssessmentForm>>;

/// The forms of these methods on the loops of a study. Methods that name mismatches have an additional number
/// `mismatch_bound` (NamedMismatch::bound), and methods that tell sources have `told_source`
/// (AssessmentRecord::told()). Throws InputError for an unknown method.
AssessmentForms assessment_forms(const Study& study, const std::vector<std::string>& methods);

/// The number `told_source` of methods that tell sources. New answers have it; archives that are older than
/// this number do not.
AssessmentNumberInfo told_source_info();

/// The answer of a method on one loop, as it is kept. Its form is the form of the method.
struct AssessmentRecord {
  std::shared_ptr<const AssessmentForm> form;
  AssessmentStatus status = AssessmentStatus::not_assessed;
  std::string reason;  ///< why there is no verdict; empty if there is one, or if the method was not asked
  bool flagged = false;
  double score = kNaN;
  Eigen::Index predicted_cv = -1;                    ///< Assessment::worst_cv(), or -1
  FaultSource predicted_source = FaultSource::none;  ///< of that CV
  Eigen::VectorXd numbers = {};  ///< in the places of the form; empty unless the status is ok
  double milliseconds = kNaN;    ///< processor time; differs from run to run

  bool answered() const { return status == AssessmentStatus::ok; }
  /// The number of this name; NaN if there is no such number or no verdict.
  double number(std::string_view name, Eigen::Index row = 0, Eigen::Index column = 0) const;
  /// All numbers of this name, rows x columns of its place; empty if there is no such number or no verdict.
  Eigen::MatrixXd values(std::string_view name) const;
  /// Stores a number in its place, which must exist.
  void set_number(std::string_view name, double value, Eigen::Index row = 0, Eigen::Index column = 0);
  /// Whether the method flags this CV.
  bool flags(Eigen::Index cv) const;
  /// `predicted_source`, with the place of the fault if the source is `other` and the archive keeps the
  /// place.
  ToldSource told() const;
  /// The source that the method sees in a flagged CV; none for other CVs.
  FaultSource source_on(Eigen::Index cv) const;
  /// Whether the method names this channel.
  bool names(const Channel& channel) const;
  /// The mismatch that the method names; none if it names none or gave no verdict.
  std::optional<NamedMismatch> named_mismatch() const;
};

/// The answers on a loop that no method has assessed.
std::vector<AssessmentRecord> unassessed(const AssessmentForms& forms);

/// The answer in the form in which it is kept.
AssessmentRecord kept(std::shared_ptr<const AssessmentForm> form, const Assessment& assessment);

/// Adds the verdict on a window to the record of the whole loop, on which the method must have a verdict.
void add_window(AssessmentRecord& record, Eigen::Index window, const Assessment& said);

}  // namespace mpm
