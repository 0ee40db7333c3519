#include "results/suite/leaderboard_words.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace mpm {

std::string marks_of(const PooledScores& scores) {
  return fmt::format("{}{}", scores.too_many_false_alarms() ? "*" : "", scores.answers_in_part() ? "~" : "");
}

std::vector<std::string> legend_sentences(const Leaderboard& board) {
  std::vector<std::string> sentences{
      fmt::format("* The interval of its own false alarms on healthy loops lies above {:g} %.",
                  100 * kMostFalseAlarms),
      fmt::format(
          "~ It gives verdicts on fewer than {:g} % of the loops: not on the same loops as the others.",
          100 * kFewestAnswers),
      fmt::format("Passed is what is done with verdicts on {0:g} % of the loops and false alarms on at most "
                  "{1:g} % of "
                  "the healthy ones: D, {2:g} % of the faults with an impact flagged; L, in {2:g} % of the "
                  "flagged loops "
                  "the affected CV named; S, in {2:g} % of all loops with a fault the right source named.",
                  100 * kFewestAnswers, 100 * kPassingFalseAlarms, 100 * kPassingShare)};
  if (std::any_of(board.overall.begin(), board.overall.end(),
                  [](const PooledScores& scores) { return scores.has_ceiling(); }))
    sentences.push_back(fmt::format(
        "The ceiling is what the method `{}` reaches, which knows what the study draws. Above 100 % "
        "of it is where a study draws what it does not know of, or where chance was kinder.",
        kCeilingMethod));
  return sentences;
}

char letter_of(LeaderboardTask task) {
  return task == LeaderboardTask::detection ? 'D' : task == LeaderboardTask::location ? 'L' : 'S';
}

std::string size_text(const Leaderboard& board) {
  std::int64_t experiments = 0, cells = 0;
  for (const CellScores& cell : board.cells) {
    experiments += cell.experiments;
    cells += cell.trouble.empty() ? 1 : 0;
  }
  return fmt::format("{} cells ({} plants, {} families), {} experiments, seed {}", cells, board.plants.size(),
                     board.families.size(), experiments, board.seed);
}

std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task) {
  std::vector<std::string> names;
  for (std::size_t family = 0; family < board.families.size(); ++family)
    if (std::none_of(
            board.by_family.begin(), board.by_family.end(),
            [&](const std::vector<PooledScores>& of_method) { return passes(of_method[family], task); }))
      names.push_back(board.families[family].name);
  return names;
}

}  // namespace mpm
