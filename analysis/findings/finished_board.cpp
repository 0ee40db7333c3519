#include "analysis/findings/finished_board.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

std::size_t loops_that_differ(const CellScores& one, const CellScores& other) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < one.truths.size(); ++i)
    differing += one.truths[i] != other.truths[i] ? 1 : 0;
  return differing;
}

/// The scores of a method of the finished board on the loops whose truth is the same in both runs.
MethodScores on_same_loops(const CellScores& cell, const CellScores& theirs, const MethodScores& scores) {
  LoopOutcomes outcomes = scores.outcomes;
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (cell.truths[i] != theirs.truths[i])
      outcomes[i].reset();
  MethodScores same = scores_of_outcomes(cell, std::move(outcomes), scores.scope);
  same.reason = scores.reason;
  same.estimates = scores.estimates;
  same.reliability = scores.reliability;
  return same;
}

/// Whether the two cells can be compared loop by loop. Adds a note if they cannot, or not on every loop.
bool has_same_loops(const CellScores& cell, const CellScores* theirs, const std::string& name,
                    std::vector<std::string>& notes) {
  if (theirs == nullptr)
    notes.push_back(fmt::format("{}: the finished board has no such cell", name));
  else if (theirs->truths.size() != cell.truths.size() || theirs->worlds != cell.worlds)
    notes.push_back(fmt::format("{}: the finished board has other loops: {} here, {} there", name,
                                cell.truths.size(), theirs->truths.size()));
  else {
    if (const std::size_t differing = loops_that_differ(cell, *theirs); differing > 0)
      notes.push_back(
          fmt::format("{}: {} of the {} loops ended differently in the finished board, and count only for "
                      "your own methods",
                      name, differing, cell.truths.size()));
    return true;
  }
  return false;
}

}  // namespace

const CellScores* FinishedBoard::same_cell(const CellScores& cell) const {
  const auto found = std::find_if(cells.begin(), cells.end(), [&cell](const CellScores& each) {
    return each.plant == cell.plant && each.family == cell.family;
  });
  return found == cells.end() || !found->trouble.empty() ? nullptr : &*found;
}

JoinedBoard join_boards(const Suite& suite, const std::vector<std::string>& own, const std::string& program,
                        std::vector<CellScores> cells, const FinishedBoard& finished, double confidence) {
  std::vector<std::string> methods, notes;
  std::vector<std::size_t> places;  // in the finished board
  for (std::size_t method = 0; method < finished.methods.size(); ++method)
    if (std::find(own.begin(), own.end(), finished.methods[method]) == own.end()) {
      places.push_back(method);
      methods.push_back(finished.methods[method]);
    }
  methods.insert(methods.end(), own.begin(), own.end());
  for (CellScores& cell : cells) {
    if (!cell.trouble.empty())
      continue;
    const std::string name = suite.name_of(cell.plant, cell.family);
    const CellScores* const theirs = finished.same_cell(cell);
    const bool same = has_same_loops(cell, theirs, name, notes);
    std::vector<MethodScores> scores;
    for (const std::size_t place : places)
      scores.push_back(same ? on_same_loops(cell, *theirs, theirs->methods[place])
                            : scores_of_outcomes(cell, {}, {}));
    std::move(cell.methods.begin(), cell.methods.end(), std::back_inserter(scores));
    cell.methods = std::move(scores);
  }
  JoinedBoard joined{make_leaderboard(suite, methods, program, std::move(cells), confidence),
                     std::move(notes)};
  if (!places.empty()) {
    joined.board.own = own;
    joined.board.finished_by = finished.runner();
  }
  return joined;
}

}  // namespace mpm
