#pragma once

#include <cstdint>
#include <optional>

#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/records/controller_check.hpp"

namespace mpm {

/// What is found in a record, in the order in which it is judged.
enum class RecordVerdict : std::int8_t {
  none,              ///< the method gives no verdict
  nothing,           ///< nothing that is worth a repair
  other_controller,  ///< the model explains the record, and the variances are not those of this controller
  unexplained_cost,  ///< the model explains the record, and the controller ran; the variances are still
                     ///< others
  fault,             ///< what the method says
};

/// "none", "nothing", "other_controller", "unexplained_cost", "fault"
const char* to_string(RecordVerdict verdict);

/// Is the score above that of simulated records without a fault? Without those, does the method say so?
bool is_above(const AssessmentRecord& said, const TrialFindings* trial);

/// The answers on a record that decide together, each with its findings on simulated records, null without
/// any.
struct RecordAnswers {
  const AssessmentRecord& said;  ///< by the method of the verdict
  const TrialFindings* trial_of_said;
  const AssessmentRecord& model;  ///< of model_check_method()
  const TrialFindings* trial_of_model;
  bool allows_errors;  ///< errors of the model are allowed for; otherwise the method has the only word
  bool has_unexplained = false;  ///< there are unexplained_cvs()

  bool model_explains() const;
  /// Does the method flag the record, and does the model not explain it?
  bool has_fault() const;
};

RecordVerdict record_verdict(const RecordAnswers& answers, const ControllerCheck& controller);

}  // namespace mpm
