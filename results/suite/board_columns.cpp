#include "results/suite/board_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "results/document/document_latex.hpp"
#include "results/files/csv_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

constexpr std::array kColumns{
    BoardColumn{kRankingSource, "naming the source of a fault"},
    BoardColumn{"power_05_impact", "finding faults"},
    BoardColumn{kRankingRepair, "naming the channel to repair"},
    BoardColumn{"detected_impact", "finding faults", "power_05_impact"},
    BoardColumn{"source_all", "naming the source of a fault", kRankingSource},
    BoardColumn{"false_alarm_calibrated"},
    BoardColumn{"false_alarm_healthy"},
};

bool has_numbers(const Leaderboard& board, const BoardColumn& column) {
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (!std::isnan(board_number(board, method, column).value))
      return true;
  return false;
}

std::string csv_number(double value) {
  return std::isnan(value) ? "" : fmt::format("{}", value);
}

}  // namespace

std::vector<BoardColumn> board_columns(const Leaderboard& board) {
  std::vector<BoardColumn> columns;
  for (const BoardColumn& column : kColumns)
    if (has_numbers(board, column) &&
        std::none_of(columns.begin(), columns.end(),
                     [&column](const BoardColumn& other) { return other.name == column.unless; }))
      columns.push_back(column);
  return columns;
}

Number board_number(const Leaderboard& board, std::size_t method, const BoardColumn& column) {
  const PooledScores& scores = board.overall[method];
  for (const RateRow& row : rate_rows())
    if (row.name == column.name) {
      const Rate& rate = scores.rates.of(row);
      return rate.total == 0 ? Number{}
                             : Number{rate.value, NumberForm::whole_percent, rate.interval, rate.total};
    }
  const Estimate& estimate = scores.estimates[column.name];
  return {estimate.value, NumberForm::whole_percent, estimate.interval, estimate.count};
}

std::vector<std::size_t> board_order(const Leaderboard& board) {
  std::vector<std::size_t> order;
  for (const RankedMethod& each : ranking(board))
    order.push_back(each.method);
  if (!order.empty())
    return order;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (board.methods[method] != kReferenceMethod)
      order.push_back(method);
  if (const std::vector<BoardColumn> columns = board_columns(board); !columns.empty()) {
    const auto value = [&](std::size_t method) {
      const double found = board_number(board, method, columns.front()).value;
      return std::isnan(found) ? -1.0 : found;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return value(a) > value(b); });
  }
  return order;
}

std::string leaderboard_csv(const Leaderboard& board) {
  const std::vector<BoardColumn> columns = board_columns(board);
  std::string text = "method,own,answers_in_part";
  for (const BoardColumn& column : columns)
    text += fmt::format(",{0},{0}_lower,{0}_upper,{0}_loops", column.name);
  for (const std::size_t method : board_order(board)) {
    text += fmt::format("\n{},{},{}", csv_field(board.methods[method]), board.is_own(method) ? 1 : 0,
                        board.overall[method].answers_in_part() ? 1 : 0);
    for (const BoardColumn& column : columns) {
      const Number number = board_number(board, method, column);
      text += fmt::format(",{},{},{},{}", csv_number(number.value), csv_number(number.interval.lower),
                          csv_number(number.interval.upper), std::max<std::int64_t>(number.of, 0));
    }
  }
  return text + "\n";
}

std::string leaderboard_latex(const Leaderboard& board) {
  const std::vector<BoardColumn> columns = board_columns(board);
  Table table("", {{"Method", Table::Align::left}});
  for (const BoardColumn& column : columns)
    table.columns.push_back({heading_of(column.name)});
  for (const std::size_t method : board_order(board)) {
    std::vector<Cell> cells{as_label(board.methods[method])};
    if (board.is_own(method))
      cells.front().tone = Cell::Tone::strong;
    for (const BoardColumn& column : columns) {
      Cell& cell = cells.emplace_back(board_number(board, method, column));
      if (board.overall[method].answers_in_part() && !std::isnan(std::get<Number>(cell.content).value))
        cell.mark = "~";
    }
    table.row(std::move(cells));
  }
  return table_latex(
      table,
      as_label(fmt::format("{} {}, seed {}, mpmbench {}: % of loops with {:g} % intervals.", board.suite,
                           board.version, board.seed, board.program, 100 * board.confidence)) +
          fmt::format("\n~: it gives verdicts on fewer than {:g} % of the loops.", 100 * kFewestAnswers));
}

}  // namespace mpm
