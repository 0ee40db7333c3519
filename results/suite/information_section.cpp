#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/leaderboard_standing.hpp"
#include "analysis/statistics/interval.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

Cell percent_cell(const PooledScores& scores, const RateRow& row) {
  const Rate& rate = scores.rates.of(row);
  if (rate.total == 0)
    return Number{};
  Cell cell = number(rate, NumberForm::whole_percent);
  cell.mark = part_mark(scores);
  return cell;
}

/// The range of shares in percent: "-1 to 46".
std::string span_text(const std::vector<double>& shares) {
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  return fmt::format("{:.0f} to {:.0f}", 100 * *least, 100 * *most);
}

/// Says what each of the two factors does to a rate; empty unless there are several methods.
std::string factors_sentence(const Leaderboard& board, const RateRow& row) {
  std::vector<double> without, with, gains;
  for (const InformationPair& pair : information_pairs(board)) {
    const BoardDuel duel = board_duel(board, row, pair.with, pair.without);
    if (duel.loops == 0)
      continue;
    without.push_back(board.overall[pair.without].rates.of(row).value);
    with.push_back(board.overall[pair.with].rates.of(row).value);
    gains.push_back(duel.difference.value);
  }
  if (gains.size() < 2)
    return "";
  const auto [least, most] = std::minmax_element(with.begin(), with.end());
  return fmt::format(
      "{}: {} % without the correction, {} % with it. The correction changes a method by {} percentage "
      "points; with it, {:.0f} lie between the methods.",
      strong(row.heading), span_text(without), span_text(with), span_text(gains), 100 * (*most - *least));
}

}  // namespace

std::vector<std::string_view> information_rates() {
  return {"false_alarm_healthy", "power_05_impact", kRankingSource};
}

Section information_section(const Leaderboard& board) {
  Section section{"information", "Effect of the correction by the benchmark"};
  const std::vector<InformationPair> pairs = information_pairs(board);
  if (pairs.empty())
    return section;
  section.say(
      "y_sim of the nominal model, or corrected by the errors that the benchmark shows: the information that "
      "a method gets is one factor, and the method itself is another.");
  std::vector<Table::Column> heads{{"Method", Table::Align::left}};
  for (const std::string_view name : information_rates()) {
    const RateRow& row = row_of(rate_rows(), name);
    heads.push_back({fmt::format("{}: without", row.heading)});
    heads.push_back({"with"});
    heads.push_back({"difference"});
    if (const std::string said = factors_sentence(board, row); !said.empty())
      section.say(said);
  }
  Table table(fmt::format("Each method with and without the correction, on the same loops: % with {:g} % "
                          "interval",
                          100 * board.confidence),
              std::move(heads));
  for (const InformationPair& pair : pairs) {
    std::vector<Cell> cells{as_label(pair.method)};
    for (const std::string_view name : information_rates()) {
      const RateRow& row = row_of(rate_rows(), name);
      const BoardDuel duel = board_duel(board, row, pair.with, pair.without);
      cells.push_back(percent_cell(board.overall[pair.without], row));
      cells.push_back(percent_cell(board.overall[pair.with], row));
      cells.emplace_back(duel.loops == 0 ? Number{}
                                         : Number{duel.difference.value, NumberForm::whole_percent,
                                                  duel.difference.interval});
    }
    table.row(std::move(cells));
  }
  section.add(std::move(table));
  return section;
}

}  // namespace mpm
