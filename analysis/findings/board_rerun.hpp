#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/statistics/share_difference.hpp"

namespace mpm {

/// A rate of a method on the loops of a board, and the same rate on a rerun of its suite with another seed.
struct RerunRate {
  std::string method;
  std::string_view rate;            ///< in rate_rows()
  Rate stated, again;               ///< of the board, of the rerun
  ShareDifference difference = {};  ///< again minus stated, independent_difference()
  double p_holm = 1.0;              ///< difference.p corrected for all rates of all methods

  bool differs(double significance) const { return p_holm < significance; }
};

/// Compares `rates` over all loops, for each method that both boards have. `rerun` is the board of a run with
/// another seed. Leaves out a rate that counts no loop on one of the boards.
std::vector<RerunRate> rerun_rates(const Leaderboard& board, const Leaderboard& rerun,
                                   const std::vector<std::string_view>& rates);

}  // namespace mpm
