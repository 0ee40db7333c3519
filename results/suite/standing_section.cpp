#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/leaderboard_standing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

/// "89 % (86 to 90)"
std::string percent_text(const Number& number) {
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", 100 * number.value, 100 * number.interval.lower,
                     100 * number.interval.upper);
}

/// "naming the source of a fault: order, 89 % (86 to 90)"; empty if no method has a number. Methods that
/// answer only on part of the loops do not count.
std::string best_of(const Leaderboard& board, const BoardColumn& column) {
  std::vector<std::string> best;
  Number most;
  for (const std::size_t method : board_order(board)) {
    const Number number = board_number(board, method, column);
    if (std::isnan(number.value) || board.overall[method].answers_in_part() || number.value < most.value)
      continue;
    if (number.value != most.value)
      best.clear();
    most = number;
    best.push_back(strong(as_label(board.methods[method])));
  }
  return best.empty() ? "" : fmt::format("{}: {}, {}", column.task, in_a_row(best), percent_text(most));
}

/// Says in one sentence which method is best at what.
std::string best_sentence(const Leaderboard& board) {
  std::vector<std::string> best;
  for (const BoardColumn& column : board_columns(board))
    if (!column.task.empty())
      if (std::string sentence = best_of(board, column); !sentence.empty())
        best.push_back(std::move(sentence));
  return best.empty() ? "" : fmt::format("Best at {}.", fmt::join(best, "; at "));
}

const char* asked_of(const Standing& standing) {
  return standing.rate == kRankingSource ? "by the right source of faults with an impact"
                                         : "by the faults with an impact that it finds";
}

Table duels_table(const Leaderboard& board, const Standing& standing) {
  Table table(
      fmt::format(
          "{} against the others on the same loops, {}, at 5 % false alarms: its share minus theirs, in %, "
          "with {:g} % interval; the decision who beats whom is corrected for the number of methods",
          as_label(board.methods[standing.method]), asked_of(standing), 100 * board.confidence),
      {{"Method", Table::Align::left}, {"Difference"}, {"Loops"}, {"", Table::Align::left}});
  for (const BoardDuel& duel : standing.duels)
    table.row({as_label(board.methods[duel.other]),
               Number{duel.difference.value, NumberForm::whole_percent, duel.difference.interval}, duel.loops,
               duel.won()    ? "beats it"
               : duel.lost() ? "loses to it"
                             : "no difference shown"});
  return table;
}

}  // namespace

std::string row_name(const Leaderboard& board, std::size_t method) {
  const std::string name = as_label(label_of(board.methods[method]));
  return board.is_own(method) ? strong(name) + " <-" : name;
}

std::string standing_sentence(const Leaderboard& board, std::size_t method,
                              const std::optional<Standing>& standing) {
  const std::string name = strong(as_label(board.methods[method]));
  if (!standing)
    return fmt::format(
        "{} cannot be ranked: it has no score above a threshold that is calibrated for 5 % "
        "false alarms, or there is no other method.",
        name);
  const auto others = static_cast<int>(standing->duels.size());
  return fmt::format(
      "{} is number {} of {} {}, at 5 % false alarms. Paired on the same loops with {} it beats {}, "
      "loses to {}, and cannot be told from {}.",
      name, standing->place, others + 1, asked_of(*standing),
      others == 1 ? "the other" : fmt::format("the {} others", others), standing->won(), standing->lost(),
      others - standing->won() - standing->lost());
}

Section standing_section(const Leaderboard& board) {
  Section section{"standing", "Who is best at what"};
  if (const std::string best = best_sentence(board); !best.empty())
    section.say(best);
  std::vector<Table> duels;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (board.is_own(method) && board.methods[method] != kReferenceMethod) {
      const std::optional<Standing> standing = standing_of(board, method);
      section.say(standing_sentence(board, method, standing));
      if (standing)
        duels.push_back(duels_table(board, *standing));
    }
  std::vector<Table::Column> heads{{"Method", Table::Align::left}};
  const std::vector<BoardColumn> columns = board_columns(board);
  for (const BoardColumn& column : columns)
    heads.push_back({heading_of(column.name)});
  Table table(
      fmt::format("% of all loops with {:g} % interval. Of the faults with an impact: sources named, faults "
                  "found, and the share of the best repair's gain that the named channel brings{}. Of the "
                  "healthy loops: those flagged.",
                  100 * board.confidence,
                  board.in_worlds() ? ", at the threshold calibrated for 5 % false alarms" : ""),
      std::move(heads));
  for (const std::size_t method : board_order(board)) {
    std::vector<Cell> cells{row_name(board, method)};
    for (const BoardColumn& column : columns) {
      Number number = board_number(board, method, column);
      Cell cell(number);
      cell.hover = number.of >= 0 ? fmt::format("{} loops", number.of) : "";
      cell.ground = number.value;
      cell.low_is_good = method_number(column.name).low_is_good;
      if (!std::isnan(number.value))
        cell.mark = part_mark(board.overall[method]);
      std::get<Number>(cell.content).of = -1;
      cells.push_back(std::move(cell));
    }
    table.row(std::move(cells));
  }
  section.add(std::move(table));
  for (Table& each : duels)
    section.add(std::move(each));
  return section;
}

}  // namespace mpm
