#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "scenarios/study.hpp"

namespace mpm {

// How reports name experiments and what is in them; plain text. Foreign names in it are as in the study.

/// "healthy", "MPM", "UD", "MPM+UD", "tuning".
std::string kind_name(ExperimentKind kind);

/// "none", "MPM", "UD", "MPM+UD".
std::string source_name(FaultSource source);

/// The name of a CV, "none" for -1.
std::string cv_name(const Study& study, Eigen::Index cv);

/// The name of an MV.
std::string mv_name(const Study& study, Eigen::Index mv);

/// What is wrong in the experiment: "gain of y1/u2 x 0.45; disturbance on y1: gain 1.2, time constant 90
/// min".
std::string fault_text(const Study& study, const ExperimentDraw& draw);

/// "experiment 12 (MPM): gain of y1/u2 x 0.45"; a named scenario has its name in place of the number.
std::string experiment_title(const Study& study, const ExperimentDraw& draw);

/// What the chain says of it: "located y1, I_MPM 0.123: MPM", with "no impact, " before it where there is
/// none; of a named scenario "flagged y1 (MPM); right"; how it ended when there is no verdict.
std::string verdict_text(const Study& study, const ExperimentRecord& record);

/// Title and verdict in lines that fit above a figure, however many faults there are.
std::vector<std::string> experiment_heading(const Study& study, const ExperimentRecord& record);

/// Title and verdict in one line.
std::string experiment_line(const Study& study, const ExperimentRecord& record);

}  // namespace mpm
