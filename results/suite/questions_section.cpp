#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

/// "97 (94 to 99) #1"; without the rank if the method does not answer the question.
Cell answer_cell(const Leaderboard& board, std::size_t method, const RateRow& row) {
  const PooledScores& scores = board.overall[method];
  const Rate& rate = scores.rates.of(row);
  if (rate.total == 0)
    return Number{};
  Cell cell = number(rate, NumberForm::whole_percent);
  const std::optional<int> rank = question_rank(board, method, row.name);
  cell.mark = part_mark(scores) + (rank ? fmt::format(" #{}", *rank) : "");
  cell.hover = fmt::format("{} of {} loops", rate.hits, rate.total);
  cell.ground = rate.value;
  return cell;
}

}  // namespace

std::vector<std::string_view> question_rates() {
  return {"power_05_impact", "mismatch_05_impact", kRankingSource,        "source_05_mpm",
          "source_05_ud",    "channel_05_impact",  "parameter_05_impact", "size_05_impact"};
}

Section questions_section(const Leaderboard& board) {
  Section section{"questions", "Who answers which question"};
  if (!board.in_worlds())
    return section;
  std::vector<const RateRow*> asked;
  std::vector<Table::Column> heads{{"Method", Table::Align::left}};
  for (const std::string_view name : question_rates()) {
    const RateRow& row = row_of(rate_rows(), name);
    if (std::none_of(board.overall.begin(), board.overall.end(),
                     [&row](const PooledScores& scores) { return scores.rates.of(row).total > 0; }))
      continue;
    asked.push_back(&row);
    heads.push_back({row.heading});
  }
  if (asked.empty())
    return section;
  Table table(
      fmt::format("% of the loops that ask the question, faults with an impact, with {:g} % interval; "
                  "#1: the first of the methods that answer it",
                  100 * board.confidence),
      std::move(heads));
  for (const std::size_t method : board_order(board)) {
    std::vector<Cell> cells{row_name(board, method)};
    for (const RateRow* const row : asked)
      cells.push_back(answer_cell(board, method, *row));
    table.row(std::move(cells));
  }
  section.add(std::move(table));
  section.say(
      "A method that names only mismatches, or only disturbances, has no rank among those that name the "
      "source, because half of the loops are outside of its question.");
  if (std::any_of(board.overall.begin(), board.overall.end(),
                  [](const PooledScores& scores) { return scores.answers_in_part(); }))
    section.say(fmt::format("~ It gives verdicts on fewer than {:g} % of the loops.", 100 * kFewestAnswers));
  return section;
}

}  // namespace mpm
