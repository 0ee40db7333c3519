#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/findings/finished_board.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "results/gates/gate_check.hpp"

namespace mpm {

/// A run of a suite that gates are applied to.
struct BoardRun {
  Suite suite;
  FinishedBoard board;  ///< of this run
  /// A finished board of the same loops, if there is one: its methods are ranked together with those of the
  /// run.
  std::optional<FinishedBoard> finished = {};
};

/// Returns the findings that gates can be put on, for each method of the run: "compare.METHOD.RATE" over all
/// loops and "compare.METHOD.FAMILY.RATE", for each rate and each pooled estimate; and
/// "compare.METHOD.place", ".beats" and ".loses_to" (standing_of()), among the methods of the run and of
/// `finished`.
std::vector<Finding> gate_findings(const BoardRun& run);

/// Judges a run of a suite. Besides the gates of the file, every run has the gates `experiments` (at least
/// minimum_experiments), `failed` (at most maximum_failed), `cells_not_run` (none), and `answered.METHOD`
/// (judge_answers()) for each method that this program does not have. If the file has [baseline], `baseline`
/// must be that run. Then there are also the gates `baseline.METHOD.QUESTION.p_worse` and `.lost`, as for a
/// campaign, for each method of both runs and each question that its outcomes answer:
///
/// | question | loops                                      | right when                            |
/// |----------|--------------------------------------------|---------------------------------------|
/// | quiet    | healthy, with a verdict                    | not flagged                           |
/// | detected | with a verdict, a fault that has an impact | flagged                               |
/// | located  | flagged, a fault that affects one CV       | this CV is named                      |
/// | source   | with a fault                               | flagged, and the right source is named |
///
/// The clusters of the test are the worlds of each cell, or the cells themselves if there are no worlds.
///
/// Errors: InputError if the baseline lacks a cell or loops of the run, or has none of its methods.
GateCheck check_gates(const BoardRun& run, const GateFile& file, const FinishedBoard* baseline = nullptr);

}  // namespace mpm
