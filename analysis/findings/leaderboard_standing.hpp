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

/// The probability that some duel of a method calls an equally good method better or worse is at most this.
inline constexpr double kDuelSignificance = 0.05;

/// Compares two methods on the same loops of a leaderboard.
struct BoardDuel {
  std::size_t other = 0;  ///< place in Leaderboard::methods
  std::int64_t loops = 0;
  /// The share of the method minus that of the other one: clustered_difference() with the worlds of each cell
  /// as clusters (without worlds: the cells) and with the further variance from the calibrated thresholds of
  /// both.
  ShareDifference difference = {};
  double p_holm = 1.0;  ///< difference.p corrected for the duels of a method (Holm 1979)

  bool won() const { return difference.value > 0 && p_holm < kDuelSignificance; }
  bool lost() const { return difference.value < 0 && p_holm < kDuelSignificance; }
};

/// Where a method stands on a leaderboard, at equal false alarms: at the threshold that is calibrated for 5 %
/// false alarms.
struct Standing {
  std::size_t method = 0;  ///< place in Leaderboard::methods
  /// The rate that is compared, a name in rate_rows(): "source_05_impact" for a method that tells sources, on
  /// a board of worlds; "power_05_impact" otherwise.
  std::string_view rate = {};
  /// Duels with each method that has the rate, except for the reference; the best opponent first.
  std::vector<BoardDuel> duels = {};
  int place = 0;  ///< 1 if no other method has a larger share on the loops in common

  int won() const;
  int lost() const;
};

/// Compares both methods over all cells, on the loops that count for the rate of each.
BoardDuel board_duel(const Leaderboard& board, const RateRow& rate, std::size_t method, std::size_t other);

/// The same method with the correction by the benchmark and without it (with_other_information()).
struct InformationPair {
  std::string method;                 ///< its name
  std::size_t without = 0, with = 0;  ///< places in Leaderboard::methods
};

/// Returns a pair for each method that the board has with and without the correction, in the order of the
/// board.
std::vector<InformationPair> information_pairs(const Leaderboard& board);

/// Returns the standing of a method; none if it has no calibrated threshold, or if no other method has the
/// rate.
std::optional<Standing> standing_of(const Leaderboard& board, std::size_t method);

}  // namespace mpm
