#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/statistics/share_difference.hpp"

namespace mpm {

/// All duels of a method together call one that is equally good better or worse so often at most.
inline constexpr double kDuelSignificance = 0.05;

/// Compares two methods on the same loops of a leaderboard.
struct BoardDuel {
  std::size_t other = 0;  ///< place in Leaderboard::methods
  std::int64_t loops = 0;
  /// The share of the method minus that of the other one: clustered_difference() of the worlds of each cell,
  /// or of the cells where there are no worlds, with what the calibrated thresholds of both leave open.
  ShareDifference difference = {};
  double p_holm = 1.0;  ///< difference.p corrected for the duels of a method (Holm 1979)

  bool won() const { return difference.value > 0 && p_holm < kDuelSignificance; }
  bool lost() const { return difference.value < 0 && p_holm < kDuelSignificance; }
};

/// Where a method stands on a leaderboard, at equal false alarms: at the threshold that is calibrated for 5 %
/// of them.
struct Standing {
  std::size_t method = 0;  ///< place in Leaderboard::methods
  /// What is counted, a name in rate_rows(): "source_05_impact" of a method that tells sources, on a
  /// board of worlds; "power_05_impact" otherwise.
  std::string_view rate = {};
  std::vector<BoardDuel> duels =
      {};         ///< with each method that has the rate, except for the reference; best first
  int place = 0;  ///< 1 where no other one has a larger share of the loops in common

  int won() const;
  int lost() const;
};

/// Both on the loops of all cells of which each has the rate.
BoardDuel board_duel(const Leaderboard& board, const RateRow& rate, std::size_t method, std::size_t other);

/// The same method with the correction by the benchmark and without it (with_other_information()).
struct InformationPair {
  std::string method;                 ///< its name
  std::size_t without = 0, with = 0;  ///< places in Leaderboard::methods
};

/// For each method that a board has in both ways, in the order of the board.
std::vector<InformationPair> information_pairs(const Leaderboard& board);

/// None where the method has no calibrated threshold, or no other one has the rate.
std::optional<Standing> standing_of(const Leaderboard& board, std::size_t method);

}  // namespace mpm
