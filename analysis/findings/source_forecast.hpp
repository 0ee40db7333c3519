#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/methods/source_probabilities.hpp"

// The reference for stated probabilities of sources: the forecast that states for every loop how often
// each source is the truth on the whole board, whatever the record shows (in meteorology: climatology).

namespace mpm {

/// How often each source is the truth in a loop of the board; none for a board without loops.
std::optional<SourceProbabilities> source_frequencies(const Leaderboard& board);

/// Mean scores; NaN without loops.
struct ForecastScores {
  double log_score = kNaN, brier_score = kNaN;
  std::int64_t loops = 0;
};

/// Scores the frequencies of the board as a forecast, on the loops of the cells for which `of` is true. With
/// a `method`, only the loops on which it gives a verdict count.
ForecastScores frequency_scores(const Leaderboard& board, const std::function<bool(const CellScores&)>& of,
                                std::optional<std::size_t> method = {});

/// 1 - mean score / mean score of the frequencies of the board on the same loops: 1 if the method always
/// states the truth with certainty, 0 if it is no better than the frequencies, below 0 if it is worse. NaN if
/// the method states no probabilities.
struct ForecastSkill {
  double log_score = kNaN, brier_score = kNaN;
};
ForecastSkill forecast_skill(const Leaderboard& board, std::size_t method);

/// Whether the method states probabilities on some loop.
bool states_probabilities(const Leaderboard& board, std::size_t method);

}  // namespace mpm
