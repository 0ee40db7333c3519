#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Returns the verdict of the chain: "located y1, I_MPM 0.123: MPM", after "no impact, " if it found none;
/// for a named scenario "flagged y1 (MPM); right"; if there is no verdict, how the experiment ended.
std::string verdict_text(const Study& study, const ExperimentRecord& record);

/// Returns title, verdict and conditions in lines that fit above a figure, even with many faults.
std::vector<std::string> experiment_heading(const Study& study, const ExperimentRecord& record);

/// Returns title and verdict in one line.
std::string experiment_line(const Study& study, const ExperimentRecord& record);

}  // namespace mpm
