#pragma once

#include <string>
#include <vector>

#include "analysis/findings/leaderboard.hpp"

namespace mpm {

/// The answers of methods on every loop of a suite, kept so that other methods can be compared with them.
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

/// The cells of your own run, with the methods of a finished board beside your own methods.
struct JoinedBoard {
  Leaderboard board;  ///< its methods: those that only the finished board has, then your own
  std::vector<std::string> notes = {};  ///< methods and cells that could not be joined, in sentences
};

/// Puts the methods of `finished` beside `own`, the methods of each of `cells`, cell by cell. A method that
/// is in both is taken from `cells`. A loop whose truth differs between the two runs counts only for your own
/// methods. So does a whole cell that the finished board lacks, or whose loops or worlds differ. `program` is
/// the version that ran `cells`. If every method of `finished` is also your own, nothing of `finished` is
/// shown and no method is marked as your own.
JoinedBoard join_boards(const Suite& suite, const std::vector<std::string>& own, const std::string& program,
                        std::vector<CellScores> cells, const FinishedBoard& finished,
                        double confidence = kBoardConfidence);

}  // namespace mpm
