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

/// Mean scores; NaN of no loop.
struct ForecastScores {
  double log_score = kNaN, brier_score = kNaN;
  std::int64_t loops = 0;
};

/// Those of the frequencies of the board, on the loops of these cells: of all of them, or of those on which
/// the method gives a verdict.
ForecastScores frequency_scores(const Leaderboard& board, const std::function<bool(const CellScores&)>& of,
                                std::optional<std::size_t> method = {});

/// 1 - mean score / mean score of the frequencies of the board on the same loops: 1 states the truth, 0 is no
/// better than the frequencies, below 0 worse. NaN of a method that states nothing.
struct ForecastSkill {
  double log_score = kNaN, brier_score = kNaN;
};
ForecastSkill forecast_skill(const Leaderboard& board, std::size_t method);

/// Does the method state probabilities on some loop?
bool states_probabilities(const Leaderboard& board, std::size_t method);

}  // namespace mpm
