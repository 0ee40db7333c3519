#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The verdict of the chain: "located y1, I_MPM 0.123: MPM", with "no impact, " before it where there is
/// none; of a named scenario "flagged y1 (MPM); right"; how it ended when there is no verdict.
std::string verdict_text(const Study& study, const ExperimentRecord& record);

/// Title, verdict and conditions in lines that fit above a figure, however many faults there are.
std::vector<std::string> experiment_heading(const Study& study, const ExperimentRecord& record);

/// Title and verdict in one line.
std::string experiment_line(const Study& study, const ExperimentRecord& record);

}  // namespace mpm
