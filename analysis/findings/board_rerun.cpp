#include "analysis/findings/board_rerun.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/statistics/holm.hpp"

namespace mpm {
namespace {

/// Returns the rate over all loops, with the worlds of all cells as its clusters. It treats the worlds as
/// drawn from one population, so an interval computed from them tends to be too long.
Rate with_worlds(const Leaderboard& board, std::size_t method, std::string_view name) {
  Rate rate = board.overall[method].rates[name];
  rate.clusters.clear();
  for (const CellScores& cell : board.cells)
    if (cell.trouble.empty()) {
      const std::vector<ClusterCount>& worlds = cell.methods[method].rates[name].clusters;
      rate.clusters.insert(rate.clusters.end(), worlds.begin(), worlds.end());
    }
  return rate;
}

}  // namespace

std::vector<RerunRate> rerun_rates(const Leaderboard& board, const Leaderboard& rerun,
                                   const std::vector<std::string_view>& rates) {
  std::vector<RerunRate> found;
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    const auto other = std::find(rerun.methods.begin(), rerun.methods.end(), board.methods[method]);
    if (other == rerun.methods.end())
      continue;
    for (const std::string_view name : rates) {
      const Rate stated = with_worlds(board, method, name),
                 again = with_worlds(rerun, static_cast<std::size_t>(other - rerun.methods.begin()), name);
      if (stated.total > 0 && again.total > 0)
        found.push_back(
            {*other, name, stated, again, independent_difference(stated, again, board.confidence)});
    }
  }
  std::vector<double> p;
  for (const RerunRate& each : found)
    p.push_back(each.difference.p);
  const std::vector<double> corrected = holm_adjusted(p);
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i].p_holm = corrected[i];
  return found;
}

}  // namespace mpm
