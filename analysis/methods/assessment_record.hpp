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

// The answers of methods as they are kept for all loops of a study: a vector of numbers for each loop, and a
// form for each method that says where in it each number stands.

namespace mpm {

/// Where one number of a method stands in AssessmentRecord::numbers: rows x columns of them, row by row.
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

/// The form of the answers of one method on the loops of one study: its own numbers, after those that follow
/// from what it tells, and before `window_flagged` (1, 0; NaN: no verdict) and `window_score` of a study that
/// monitors:
///
/// | name            | scope   | of methods that |
/// |-----------------|---------|-----------------|
/// | cv_flagged      | cv      | locate CVs: 1 flagged, 0 not; NaN: nothing is said about it |
/// | cv_score        | cv      | locate CVs: CvAssessment::score                          |
/// | cv_source       | cv      | tell sources: FaultSource of a flagged CV or the worst one |
/// | channel_flagged | channel | name channels: 1 for a channel that is named, 0 for others |
/// | mismatch_parameter | channel | name mismatches: Assessment::named_mismatch instead of its channel |
/// | mismatch_size, mismatch_lower, mismatch_upper | channel | the same, NaN elsewhere           |
/// | named_candidate | loop    | name candidates: Assessment::named_candidate; NaN: none           |
class AssessmentForm {
 public:
  AssessmentForm(MethodDescription method, const Study& study);

  /// Without the numbers that follow from its verdicts.
  const MethodDescription& method() const { return method_; }
  const std::vector<NumberPlace>& places() const { return places_; }
  /// Numbers in all.
  Eigen::Index size() const { return size_; }
  /// The place of the number of this name; null when there is none.
  const NumberPlace* find(std::string_view name) const;

 private:
  void add(AssessmentNumberInfo info, const Study& study);

  MethodDescription method_;
  std::vector<NumberPlace> places_;
  Eigen::Index size_ = 0;
};

/// Lags of the numbers with the scope cv_lag: 0 ... a quarter of the record, as AcfComparisonOptions has it.
Eigen::Index lag_count(const Study& study);

/// Of several methods, in their order.
using AssessmentForms = std::vector<std::shared_ptr<const AssessmentForm>>;

/// The forms of these methods on the loops of a study. Those that name mismatches have a number
/// `mismatch_bound` besides, NamedMismatch::bound, and those that tell sources `told_source`,
/// AssessmentRecord::told(). Throws InputError for an unknown method.
AssessmentForms assessment_forms(const Study& study, const std::vector<std::string>& methods);

/// The number `told_source`, which methods have that tell sources and are asked anew: archives that were
/// written before there was one have none.
AssessmentNumberInfo told_source_info();

/// The answer of a method on one loop, as it is kept. Its form is that of the method.
struct AssessmentRecord {
  std::shared_ptr<const AssessmentForm> form;
  AssessmentStatus status = AssessmentStatus::not_assessed;
  std::string reason;  ///< why there is no verdict; empty if there is one, or if the method was not asked
  bool flagged = false;
  double score = kNaN;
  Eigen::Index predicted_cv = -1;                    ///< Assessment::worst_cv(), -1 for none
  FaultSource predicted_source = FaultSource::none;  ///< of that CV
  Eigen::VectorXd numbers = {};                      ///< as the form has them; empty unless the status is ok
  double milliseconds = kNaN;                        ///< processor time; differs from run to run

  bool answered() const { return status == AssessmentStatus::ok; }
  /// The number of this name; NaN when there is none, or no verdict.
  double number(std::string_view name, Eigen::Index row = 0, Eigen::Index column = 0) const;
  /// All numbers of this name, rows x columns of its place; empty when there is none, or no verdict.
  Eigen::MatrixXd values(std::string_view name) const;
  /// Stores a number in its place, which must exist.
  void set_number(std::string_view name, double value, Eigen::Index row = 0, Eigen::Index column = 0);
  /// Whether the method flags this CV.
  bool flags(Eigen::Index cv) const;
  /// `predicted_source`, of `other` with what it is about; without that in an archive that does not keep it.
  ToldSource told() const;
  /// The source that it sees in a flagged CV.
  FaultSource source_on(Eigen::Index cv) const;
  /// Whether the method names this channel.
  bool names(const Channel& channel) const;
  /// The mismatch that it names; none: it names none, or gave no verdict.
  std::optional<NamedMismatch> named_mismatch() const;
};

/// The answers on a loop that no method has assessed.
std::vector<AssessmentRecord> unassessed(const AssessmentForms& forms);

/// The answer in the form in which it is kept.
AssessmentRecord kept(std::shared_ptr<const AssessmentForm> form, const Assessment& assessment);

/// Adds the verdict on a window to the record of the whole loop, on which the method must have a verdict.
void add_window(AssessmentRecord& record, Eigen::Index window, const Assessment& said);

}  // namespace mpm
