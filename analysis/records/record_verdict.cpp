#include "analysis/records/record_verdict.hpp"

namespace mpm {

const char* to_string(RecordVerdict verdict) {
  switch (verdict) {
    case RecordVerdict::none:
      return "none";
    case RecordVerdict::nothing:
      return "nothing";
    case RecordVerdict::other_controller:
      return "other_controller";
    case RecordVerdict::unexplained_cost:
      return "unexplained_cost";
    case RecordVerdict::fault:
      return "fault";
  }
  return "none";
}

bool is_above(const AssessmentRecord& said, const TrialFindings* trial) {
  return said.answered() && (trial == nullptr ? said.flagged : said.score > trial->threshold);
}

bool RecordAnswers::model_explains() const {
  return allows_errors && model.answered() && !has_unexplained && !is_above(model, trial_of_model);
}

bool RecordAnswers::has_fault() const {
  if (!said.answered() || !said.flagged)
    return false;
  return allows_errors && model.answered() ? !model_explains() : is_above(said, trial_of_said);
}

RecordVerdict record_verdict(const RecordAnswers& answers, const ControllerCheck& controller) {
  if (!answers.said.answered())
    return RecordVerdict::none;
  if (answers.has_fault())
    return RecordVerdict::fault;
  if (!answers.model_explains() || !is_above(answers.said, answers.trial_of_said))
    return RecordVerdict::nothing;
  return controller.is_alike() ? RecordVerdict::unexplained_cost : RecordVerdict::other_controller;
}

}  // namespace mpm
