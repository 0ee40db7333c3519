#include "results/suite/leaderboard_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/text/experiment_text.hpp"

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
  if (has_reference(board))
    sentences.push_back(
        fmt::format("The reference is the method `{}`, which knows what the study draws. It is shown in the "
                    "families that "
                    "draw exactly what it knows of; above 100 % of it chance was kinder.",
                    kReferenceMethod));
  sentences.emplace_back(kOfOneBenchmark);
  return sentences;
}

std::string label_of(const std::string& method) {
  return method == kReferenceMethod ? "reference" : method;
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

std::vector<const CellScores*> monitored_cells(const Leaderboard& board, std::size_t family) {
  std::vector<const CellScores*> cells;
  for (const CellScores& cell : board.cells)
    if (cell.family == family && cell.monitored && cell.trouble.empty())
      cells.push_back(&cell);
  std::sort(cells.begin(), cells.end(),
            [](const CellScores* a, const CellScores* b) { return a->plant < b->plant; });
  return cells;
}

std::string plant_and_unit(const Leaderboard& board, const CellScores& cell) {
  return fmt::format("{} ({})", board.plants[cell.plant].name, cell.time_unit);
}

namespace {

/// With this many digits, and all of those before the point: 1616 instead of 1.62e+03.
std::string plain_number(double value, int digits) {
  return value + 0.5 < std::pow(10.0, digits) ? fmt::format("{:.{}g}", value, digits)
                                              : fmt::format("{:.0f}", value);
}

std::string time_words(double time) {
  return std::isinf(time) ? "never" : plain_number(time, 3);
}

}  // namespace

std::string delay_words(const MethodScores& scores) {
  const Estimate delay = scores.estimate("detection_delay"), alarms = scores.estimate("false_alarms_a_day");
  if (delay.count == 0 && alarms.count == 0)
    return "-";
  std::string text = delay.count == 0 ? "-" : time_words(delay.value);
  if (delay.count > 0 && !std::isnan(delay.interval.lower))
    text += fmt::format(" ({} to {})", time_words(delay.interval.lower), time_words(delay.interval.upper));
  return alarms.count == 0 ? text : text + "; " + plain_number(alarms.value, 2);
}

std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task) {
  std::vector<std::string> names;
  const auto somebody_passes = [&](std::size_t family) {
    for (std::size_t method = 0; method < board.methods.size(); ++method)
      if (board.methods[method] != kReferenceMethod && passes(board.by_family[method][family], task))
        return true;
    return false;
  };
  for (std::size_t family = 0; family < board.families.size(); ++family)
    if (!somebody_passes(family))
      names.push_back(board.families[family].name);
  return names;
}

}  // namespace mpm
