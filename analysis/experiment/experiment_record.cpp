#include "analysis/experiment/experiment_record.hpp"

#include <algorithm>

#include "analysis/methods/thesis/chain_numbers.hpp"

namespace mpm {

std::string_view to_string(ExperimentStatus status) {
  switch (status) {
    case ExperimentStatus::ok:
      return "ok";
    case ExperimentStatus::infeasible:
      return "infeasible";
    case ExperimentStatus::failed:
      return "failed";
    case ExperimentStatus::unstable:
      return "unstable";
  }
  return "unknown";
}

const AssessmentRecord* ExperimentRecord::by(std::string_view method) const {
  const auto found = std::find_if(assessments.begin(), assessments.end(), [method](const auto& assessment) {
    return assessment.form->method().name == method;
  });
  return found == assessments.end() ? nullptr : &*found;
}

const AssessmentRecord* ExperimentRecord::diagnosed() const {
  const auto found = std::find_if(assessments.begin(), assessments.end(),
                                  [](const auto& assessment) { return diagnoses(*assessment.form); });
  return found == assessments.end() ? nullptr : &*found;
}

Diagnosis ExperimentRecord::chain() const {
  const AssessmentRecord* const said = diagnosed();
  return said == nullptr ? Diagnosis{} : diagnosis_of(*said);
}

}  // namespace mpm
