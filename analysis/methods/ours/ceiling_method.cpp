#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/fault_posterior.hpp"

namespace mpm {

/// The likelihood of the faults that the study draws, as often and as large as it draws them. No method that
/// is told less can do better on that study, so far as the study draws what the likelihood knows of
/// (docs/methods.md): what it reaches is the ceiling of the leaderboard.
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
