#include "analysis/findings/leaderboard_standing.hpp"

#include <algorithm>
#include <string>

#include "analysis/findings/world_counts.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/statistics/holm.hpp"

namespace mpm {
namespace {

bool tells_sources(const Leaderboard& board, std::size_t method) {
  return std::any_of(board.cells.begin(), board.cells.end(), [method](const CellScores& cell) {
    return cell.trouble.empty() && cell.methods[method].scope.tells_sources;
  });
}

}  // namespace

BoardDuel board_duel(const Leaderboard& board, const RateRow& rate, std::size_t method, std::size_t other) {
  std::vector<PairedCounts> clusters;
  for (const CellScores& cell : board.cells) {
    if (!cell.trouble.empty())
      continue;
    const MethodScores &ours = cell.methods[method], &theirs = cell.methods[other];
    OfWorlds<PairedCounts> worlds;
    for (std::size_t i = 0; i < std::min({ours.outcomes.size(), theirs.outcomes.size(), cell.truths.size()});
         ++i) {
      if (!ours.outcomes[i] || !theirs.outcomes[i])
        continue;
      const std::optional<bool> first = rate.ask({theirs.scope, *cell.truths[i], *theirs.outcomes[i]}),
                                second = rate.ask({ours.scope, *cell.truths[i], *ours.outcomes[i]});
      if (first && second)
        worlds.of(cell.worlds[i]).add(*first, *second);
    }
    clusters.insert(clusters.end(), worlds.all().begin(), worlds.all().end());
  }
  BoardDuel found{.other = other, .loops = pooled_counts(clusters).total()};
  if (found.loops > 0)
    found.difference = clustered_difference(clusters, board.confidence,
                                            board.overall[method].rates.of(rate).further_variance +
                                                board.overall[other].rates.of(rate).further_variance);
  return found;
}

std::vector<InformationPair> information_pairs(const Leaderboard& board) {
  const auto place_of = [&board](const std::string& name) {
    return std::find(board.methods.begin(), board.methods.end(), name);
  };
  std::vector<InformationPair> pairs;
  for (std::size_t i = 0; i < board.methods.size(); ++i)
    for (const std::string_view end : {kCorrected, kUncorrected}) {
      const auto other = place_of(board.methods[i] + std::string(end));
      if (other == board.methods.end())
        continue;
      const auto variant = static_cast<std::size_t>(other - board.methods.begin());
      const bool gains = end == kCorrected;
      pairs.push_back({board.methods[i], gains ? i : variant, gains ? variant : i});
    }
  return pairs;
}

int Standing::won() const {
  return static_cast<int>(
      std::count_if(duels.begin(), duels.end(), [](const BoardDuel& d) { return d.won(); }));
}

int Standing::lost() const {
  return static_cast<int>(
      std::count_if(duels.begin(), duels.end(), [](const BoardDuel& d) { return d.lost(); }));
}

std::optional<Standing> standing_of(const Leaderboard& board, std::size_t method) {
  Standing standing;
  standing.method = method;
  standing.rate = board.in_worlds() && tells_sources(board, method) ? kRankingSource : "power_05_impact";
  const RateRow& rate = row_of(rate_rows(), standing.rate);
  for (std::size_t other = 0; other < board.methods.size(); ++other)
    if (other != method && board.methods[other] != kReferenceMethod)
      if (const BoardDuel found = board_duel(board, rate, method, other); found.loops > 0)
        standing.duels.push_back(found);
  if (standing.duels.empty())
    return std::nullopt;
  std::vector<double> p;
  for (const BoardDuel& each : standing.duels)
    p.push_back(each.difference.p);
  const std::vector<double> corrected = holm_adjusted(p);
  for (std::size_t i = 0; i < corrected.size(); ++i)
    standing.duels[i].p_holm = corrected[i];
  std::stable_sort(standing.duels.begin(), standing.duels.end(), [](const BoardDuel& a, const BoardDuel& b) {
    return a.difference.value < b.difference.value;
  });
  standing.place =
      1 + static_cast<int>(std::count_if(standing.duels.begin(), standing.duels.end(),
                                         [](const BoardDuel& d) { return d.difference.value < 0; }));
  return standing;
}

}  // namespace mpm
