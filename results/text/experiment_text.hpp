#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/findings/method_rates.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Says in one sentence what the intervals of a table of rates hold for: the one benchmark of a study, or
/// worlds drawn at random.
std::string whose_intervals(bool in_worlds);

/// Counts things: "1 cell", "3 cells", "2 families". The plural ends with s unless `things` is given.
std::string counted(std::int64_t count, const std::string& thing, const std::string& things = "");

// How reports name experiments and their faults, in plain text. Names from a study stay as they are there.

/// Describes the failures of a method: "failed on 3 of the 20 loops on which it was asked, first with:
/// singular matrix".
std::string failures_text(const VerdictFailures& failures);

/// "healthy", "MPM", "UD", "MPM+UD", "tuning".
std::string kind_name(ExperimentKind kind);

/// "none", "MPM", "UD", "MPM+UD".
std::string source_name(FaultSource source);

/// The name of a CV; "none" for -1.
std::string cv_name(const Study& study, Eigen::Index cv);

/// The name of an MV.
std::string mv_name(const Study& study, Eigen::Index mv);

/// Describes what is wrong in the experiment: "gain of y1/u2 x 0.45; disturbance on y1: gain 1.2, time
/// constant 90 min".
std::string fault_text(const Study& study, const ExperimentDraw& draw);

/// "experiment 12 (MPM): gain of y1/u2 x 0.45". A named scenario has its name in place of the number.
std::string experiment_title(const Study& study, const ExperimentDraw& draw);

/// Formats an estimate: "0.62 (0.55 to 0.7)", without the brackets if the interval is not known. If the
/// estimate is 8 at the end of its search, where its interval (7.1 to 8) is open: "at least 7.1". A value
/// that differs from 0 only by rounding is 0.
std::string estimate_text(double value, double lower, double upper, SizeBound bound);

/// Describes a change of a dead time: "longer by 1.5 (1.2 to 1.8) min", "shorter by at least 2 min".
std::string dead_time_text(double shift, double lower, double upper, SizeBound bound,
                           const std::string& unit);

/// Says whether the loop is stable, and how often it runs with other constraints than the basis case: "loop
/// stable (spectral radius 0.982); another CV at a limit in 2 % of the samples, an MV in 0 %". Empty if
/// nothing is known.
std::string conditions_text(const ExperimentRecord& record);

}  // namespace mpm
