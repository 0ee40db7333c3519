#pragma once

#include <string>

#include "analysis/experiment/judgement.hpp"

namespace mpm {

// How reports describe named scenarios, in plain text. Names from a study stay as they are there.

/// The name of a scenario.
const std::string& scenario_name(const Study& study, const ExperimentRecord& record);

/// The affected CVs and the sources that affect them: "y2 (UD), y3 (MPM)", or "none".
std::string affected_text(const Study& study, const ExperimentDraw& draw);

/// The flagged CVs and the source that I_MPM indicates, in the same form.
std::string flagged_text(const Study& study, const AssessmentRecord& chain);

/// The verdict compared with the truth: "right", or what is wrong: "missed y2; false alarm y4; source of y1".
/// If there is no verdict, how the experiment ended.
std::string scenario_verdict_text(const Study& study, const ExperimentRecord& record);

/// What the autocorrelation functions tell about a CV: "alike"; "slower than designed, oscillates; own
/// model".
std::string acf_text(const AcfComparison& acf);

/// Tells whether the loop differs from its nominal output in speed or in oscillation.
bool acf_differs(const AcfComparison& acf);

}  // namespace mpm
