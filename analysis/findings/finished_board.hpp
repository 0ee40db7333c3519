#pragma once

#include <string>
#include <vector>

#include "analysis/findings/leaderboard.hpp"

namespace mpm {

/// What methods have said about every loop of a suite, kept so that others can be compared with it.
struct FinishedBoard {
  std::string program;   ///< version of the program that ran it
  std::string revision;  ///< of its source
  std::vector<std::string> methods = {};
  std::vector<CellScores> cells = {};  ///< with places in Suite::plants and Suite::families

  /// The same cell in this run; null if it was not run.
  const CellScores* same_cell(const CellScores& cell) const;
  /// "mpmbench 1.0 (revision)"
  std::string runner() const { return "mpmbench " + program + " (" + revision + ")"; }
};

/// The cells of one's own run, with the methods of a finished board beside one's own.
struct JoinedBoard {
  Leaderboard board;  ///< methods: those of the finished board that are not one's own, and these
  std::vector<std::string> notes = {};  ///< methods and cells that could not be joined, in sentences
};

/// Puts the methods of `finished` beside `own`, the methods of each of `cells`, cell by cell. A method in
/// both is taken from `cells`. A loop whose truth differs between the two counts only for your own methods;
/// so does a whole cell that the finished board lacks, or whose loops or worlds differ. `program`: the
/// version that has run `cells`. Where every method of `finished` is one's own too, nothing of it is shown,
/// and nobody is marked.
JoinedBoard join_boards(const Suite& suite, const std::vector<std::string>& own, const std::string& program,
                        std::vector<CellScores> cells, const FinishedBoard& finished,
                        double confidence = kBoardConfidence);

}  // namespace mpm
