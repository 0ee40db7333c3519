#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/fault_posterior.hpp"

namespace mpm {

AssessmentMethodInfo likelihood_method() {
  return {{.name = "likelihood",
           .title = "likelihood of the faults",
           .verdict = "a fault is more probable than none, given the record",
           .requirements = {.benchmark = true, .complete_record = false},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = true,
           .names_mismatches = true,
           .numbers = fault_posterior_numbers()},
          {},
          [](const AssessmentContext& context) {
            return make_fault_posterior(context, context.study.assessment.likelihood.priors);
          }};
}

}  // namespace mpm
