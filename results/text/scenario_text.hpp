#pragma once

#include <string>

#include "analysis/experiment/judgement.hpp"

namespace mpm {

// How reports speak of named scenarios; plain text, with foreign names in it as in the study.

/// The name of a scenario.
const std::string& scenario_name(const Study& study, const ExperimentRecord& record);

/// The CVs that are affected, and by what: "y2 (UD), y3 (MPM)"; "none".
std::string affected_text(const Study& study, const ExperimentDraw& draw);

/// The CVs that are flagged, and the source that I_MPM points at, in the same form.
std::string flagged_text(const Study& study, const AssessmentRecord& chain);

/// The verdict against the truth: "right", or what is wrong: "missed y2; false alarm y4; source of y1"; how
/// the experiment ended when there is no verdict.
std::string scenario_verdict_text(const Study& study, const ExperimentRecord& record);

/// What the autocorrelation functions say about a CV: "alike"; "slower than designed, oscillates; own model".
std::string acf_text(const AcfComparison& acf);

/// Does the loop differ from its nominal output, in speed or in oscillation?
bool acf_differs(const AcfComparison& acf);

}  // namespace mpm
