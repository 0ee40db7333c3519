#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/fault_posterior.hpp"

namespace mpm {

/// The likelihood of the faults that the study draws; its priors are how often and how large the study draws
/// them. No method that is told less can do better on that study, as far as the likelihood knows everything
/// that the study draws (docs/methods.md). So its result is the ceiling of the leaderboard.
AssessmentMethodInfo ceiling_method() {
  return {{.name = "ceiling",
           .title = "likelihood that knows the study",
           .verdict = "a fault is more probable than none, given the record and the priors of the study",
           .requirements = {.benchmark = true, .complete_record = false},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = true,
           .names_mismatches = true,
           .information = ModelInformation::unused,
           .numbers = fault_posterior_numbers()},
          {},
          [](const AssessmentContext& context) { return make_fault_posterior(context, FaultPriors::study); }};
}

}  // namespace mpm
