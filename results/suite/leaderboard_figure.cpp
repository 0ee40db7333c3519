#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

const Pen kOthers{colour::kBlue, Dash::solid, Mark::dot, 1.2, 0.7};
const Pen kOwn{colour::kVermillion, Dash::solid, Mark::diamond, 2.4, 1.1};

/// Draws one row per method, in the same order in all panels.
Panel column_panel(const Leaderboard& board, const std::vector<std::size_t>& order,
                   const BoardColumn& column) {
  const auto rows = static_cast<double>(order.size());
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  for (const std::size_t method : order)
    y.words.push_back(board.methods[method] + part_mark(board.overall[method]));
  std::reverse(y.words.begin(), y.words.end());  // the first one is on top
  const MethodNumber number_text = method_number(column.name);
  PanelScript panel(number_text.name, number_text.heading,
                    {.label = number_text.low_is_good ? "% of loops, left is good" : "%, right is good",
                     .lower = -2,
                     .upper = 102,
                     .ticks = {0, 20, 40, 60, 80, 100}},
                    y);
  std::vector<Whisker> own, others;
  double at = rows;
  for (const std::size_t method : order) {
    const Number number = board_number(board, method, column);
    at -= 1.0;
    if (std::isnan(number.value))
      continue;
    const double value = 100 * number.value, lower = 100 * number.interval.lower,
                 upper = 100 * number.interval.upper;
    (board.is_own(method) ? own : others)
        .push_back({at, value, lower, upper,
                    fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, of {} loops",
                                board.methods[method], value, lower, upper, number.of)});
  }
  panel.level_whiskers(others, kOthers);
  panel.level_whiskers(own, kOwn);
  return panel.finish(
      fmt::format("{}, with intervals, one row a method: {}.", number_text.heading, number_text.meaning),
      70.0 + 20.0 * rows);
}

}  // namespace

Figure leaderboard_figure(const Leaderboard& board) {
  Figure figure;
  figure.name = "leaderboard";
  figure.caption = fmt::format(
      "Every method with {:g} % intervals over all loops of the suite, in the order of the table. Faults are "
      "those with an impact; unless it says otherwise, methods are compared at 5 % false alarms.",
      100 * board.confidence);
  if (!board.own.empty())
    figure.legend = {{"marked", kOwn}, {"others", kOthers}};
  const std::vector<std::size_t> order = board_order(board);
  for (const BoardColumn& column : board_columns(board))
    figure.panels.push_back(column_panel(board, order, column));
  return figure;
}

}  // namespace mpm
