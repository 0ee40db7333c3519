#include "analysis/findings/leaderboard_standing.hpp"

#include <algorithm>
#include <string>

#include "analysis/findings/world_counts.hpp"

namespace mpm {
namespace {

enum class Asked { source, power };

/// Is the loop one that the rate counts, and is it a hit? None: it is not counted.
std::optional<bool> hit_or_miss(Asked what, const FaultTruth& truth, const LoopOutcome& said) {
  if (!truth.faulty() || !truth.impact || (what == Asked::power && !said.answered))
    return std::nullopt;
  return said.above_05 && (what == Asked::power || said.right_source);
}

/// Can the method have the rate on the loops of this cell?
bool has_rate(Asked what, const MethodScores& scores) {
  return scores.scope.at_05 && (what == Asked::power || scores.scope.tells_sources);
}

/// Both on the loops of all cells: the other one first.
BoardDuel duel(const Leaderboard& board, Asked what, std::size_t method, std::size_t other) {
  std::vector<PairedCounts> clusters;
  for (const CellScores& cell : board.cells) {
    if (!cell.trouble.empty() || !has_rate(what, cell.methods[method]) ||
        !has_rate(what, cell.methods[other]))
      continue;
    const std::string &ours = cell.methods[method].outcomes, &theirs = cell.methods[other].outcomes;
    OfWorlds<PairedCounts> worlds;
    for (std::size_t i = 0; i < std::min({ours.size(), theirs.size(), cell.truths.size()}); ++i) {
      if (ours[i] == kNoLoop || theirs[i] == kNoLoop)
        continue;
      const FaultTruth truth = *fault_truth(cell.truths[i]);
      const auto first = hit_or_miss(what, truth, *loop_outcome(theirs[i])),
                 second = hit_or_miss(what, truth, *loop_outcome(ours[i]));
      if (first && second)
        worlds.of(cell.worlds[i]).add(*first, *second);
    }
    clusters.insert(clusters.end(), worlds.all().begin(), worlds.all().end());
  }
  BoardDuel found{.other = other, .loops = pooled_counts(clusters).total()};
  if (found.loops > 0)
    found.difference = clustered_difference(clusters, board.confidence);
  return found;
}

bool tells_sources(const Leaderboard& board, std::size_t method) {
  return std::any_of(board.cells.begin(), board.cells.end(), [method](const CellScores& cell) {
    return cell.trouble.empty() && cell.methods[method].scope.tells_sources;
  });
}

}  // namespace

int Standing::won() const {
  return static_cast<int>(
      std::count_if(duels.begin(), duels.end(), [](const BoardDuel& d) { return d.won(); }));
}

int Standing::lost() const {
  return static_cast<int>(
      std::count_if(duels.begin(), duels.end(), [](const BoardDuel& d) { return d.lost(); }));
}

std::optional<Standing> standing_of(const Leaderboard& board, std::size_t method) {
  const Asked what = board.in_worlds() && tells_sources(board, method) ? Asked::source : Asked::power;
  Standing standing;
  standing.method = method;
  standing.rate = what == Asked::source ? kRankingSource : "power_05_impact";
  for (std::size_t other = 0; other < board.methods.size(); ++other)
    if (other != method && board.methods[other] != kReferenceMethod)
      if (const BoardDuel found = duel(board, what, method, other); found.loops > 0)
        standing.duels.push_back(found);
  if (standing.duels.empty())
    return std::nullopt;
  std::stable_sort(standing.duels.begin(), standing.duels.end(), [](const BoardDuel& a, const BoardDuel& b) {
    return a.difference.value < b.difference.value;
  });
  standing.place =
      1 + static_cast<int>(std::count_if(standing.duels.begin(), standing.duels.end(),
                                         [](const BoardDuel& d) { return d.difference.value < 0; }));
  return standing;
}

}  // namespace mpm
