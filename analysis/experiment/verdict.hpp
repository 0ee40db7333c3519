#pragma once

#include <cstdint>
#include <string_view>

#include "analysis/experiment/experiment.hpp"

namespace mpm {

/// What one question about an experiment came to.
enum class Verdict : std::int8_t {
  none,  ///< not asked: the experiment is infeasible, failed, or outside of the population
  wrong,
  right,
};

std::string_view to_string(Verdict verdict);

/// Is the affected CV the one that Ivar_diag points at (figures 6.20, 6.23)? Asked of impactful experiments.
/// Of a named scenario: are the affected CVs those that are flagged? Not asked where no CV is affected:
/// impact is a false alarm then, wherever it is seen (analysis/false_alarms).
Verdict location_verdict(const ExperimentRecord& record);

/// The experiments over which the study counts the rates of I_MPM.
bool in_source_population(const Study& study, const ExperimentRecord& record);

/// Does I_MPM lie on the side of its threshold that the fault belongs to (figure 6.21)? Asked of experiments
/// with a single fault in that population, and of the found CVs of a named scenario that have one sort of
/// fault.
Verdict source_verdict(const Study& study, const ExperimentRecord& record);

}  // namespace mpm
