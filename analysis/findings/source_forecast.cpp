#include "analysis/findings/source_forecast.hpp"

#include <array>
#include <cstdint>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

bool any_cell(const CellScores&) {
  return true;
}

/// Calls visit(truth) for each loop of the cells for which `of` is true; with a `method`, only for the loops
/// on which it gives a verdict.
void each_truth(const Leaderboard& board, const std::function<bool(const CellScores&)>& of,
                std::optional<std::size_t> method, const std::function<void(FaultSource)>& visit) {
  for (const CellScores& cell : board.cells) {
    if (!cell.trouble.empty() || !of(cell))
      continue;
    for (std::size_t loop = 0; loop < cell.truths.size(); ++loop) {
      if (!cell.truths[loop])
        continue;
      if (method) {
        const LoopOutcomes& said = cell.methods[*method].outcomes;
        if (loop >= said.size() || !said[loop] || !said[loop]->answered)
          continue;
      }
      visit(source_of(cell.truths[loop]->kind));
    }
  }
}

}  // namespace

std::optional<SourceProbabilities> source_frequencies(const Leaderboard& board) {
  std::array<std::int64_t, kWords<FaultSource>.size()> counts{};
  std::int64_t loops = 0;
  each_truth(board, any_cell, std::nullopt, [&](FaultSource truth) {
    ++counts[static_cast<std::size_t>(truth)];
    ++loops;
  });
  if (loops == 0)
    return std::nullopt;
  SourceProbabilities frequencies{};
  for (std::size_t i = 0; i < counts.size(); ++i)
    frequencies[i] = static_cast<double>(counts[i]) / static_cast<double>(loops);
  return frequencies;
}

ForecastScores frequency_scores(const Leaderboard& board, const std::function<bool(const CellScores&)>& of,
                                std::optional<std::size_t> method) {
  ForecastScores scores;
  const std::optional<SourceProbabilities> frequencies = source_frequencies(board);
  double log_sum = 0.0, brier_sum = 0.0;
  if (frequencies)
    each_truth(board, of, method, [&](FaultSource truth) {
      log_sum += log_score(*frequencies, truth);
      brier_sum += brier_score(*frequencies, truth);
      ++scores.loops;
    });
  if (scores.loops > 0) {
    scores.log_score = log_sum / static_cast<double>(scores.loops);
    scores.brier_score = brier_sum / static_cast<double>(scores.loops);
  }
  return scores;
}

ForecastSkill forecast_skill(const Leaderboard& board, std::size_t method) {
  const ForecastScores reference = frequency_scores(board, any_cell, method);
  const Estimates& found = board.overall[method].estimates;
  return {1.0 - found["log_score"].value / reference.log_score,
          1.0 - found["brier_score"].value / reference.brier_score};
}

bool states_probabilities(const Leaderboard& board, std::size_t method) {
  return board.overall[method].reliability.count() > 0;
}

}  // namespace mpm
