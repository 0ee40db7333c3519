#include "analysis/experiment/experiment_record.hpp"

#include <algorithm>

#include "analysis/methods/thesis/chain_numbers.hpp"

namespace mpm {

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

const AssessmentRecord& ExperimentRecord::chain() const {
  static const AssessmentRecord none;
  const AssessmentRecord* const said = diagnosed();
  return said == nullptr ? none : *said;
}

}  // namespace mpm
