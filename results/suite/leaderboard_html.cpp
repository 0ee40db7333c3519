#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/method_rates.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/figure_html.hpp"
#include "results/report/html_page.hpp"
#include "results/report/html_table.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "results/suite/leaderboard_words.hpp"

namespace mpm {
namespace {

using AllScores = std::vector<std::vector<PooledScores>>;  // [method][column]

/// The share of what the reference reached; nothing where there is none.
std::string share_html(const PooledScores& scores, const LeaderboardScore& score) {
  const std::vector<LeaderboardScore> known = leaderboard_scores();
  for (std::size_t i = 0; i < scores.shares_of_ceiling.size(); ++i)
    if (known[i].rate == score.rate && !std::isnan(scores.shares_of_ceiling[i]))
      return fmt::format("<br><small>{:.0f} % of reference</small>", 100 * scores.shares_of_ceiling[i]);
  return "";
}

/// A number on a ground that is deeper the better it is; one where low is good in another colour, deeper the
/// worse it is.
std::string score_html(const PooledScores& scores, const LeaderboardScore& score) {
  const Rate* const rate = scores.of(score.rate);
  if (rate == nullptr || rate->total == 0)
    return "<span class=\"none\">&ndash;</span>";
  constexpr double kDeepest = 0.55;  // black text stays readable
  return fmt::format(
      "<div style=\"background:rgba({},{:.3f});padding:0.2rem 0.4rem\" title=\"{} of {} loops\">{:.0f}{}"
      "<br><small>{:.0f} to {:.0f}</small>{}</div>",
      score.low_is_good ? "213,94,0" : "0,114,178", kDeepest * rate->value, rate->hits, rate->total,
      100 * rate->value, marks_of(scores), 100 * rate->interval.lower, 100 * rate->interval.upper,
      share_html(scores, score));
}

std::vector<HtmlTable::Column> columns_for(const std::vector<SuiteAxis>& axis) {
  std::vector<HtmlTable::Column> columns{{"Method", HtmlTable::Align::left}};
  for (const SuiteAxis& entry : axis)
    columns.push_back({html_text(entry.name)});
  columns.push_back({"all"});
  return columns;
}

/// One row a method; `cell` makes the entries.
std::string methods_table(const Leaderboard& board, const std::string& caption,
                          const std::vector<SuiteAxis>& axis, const AllScores& scores, const auto& cell) {
  HtmlTable table(caption, columns_for(axis));
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    std::vector<std::string> cells{html_text(label_of(board.methods[method]))};
    for (const PooledScores& entry : scores[method])
      cells.push_back(cell(entry));
    cells.push_back(cell(board.overall[method]));
    table.row(cells);
  }
  return table.html();
}

std::string scores_section(const Leaderboard& board, const char* id, const char* title,
                           const std::vector<SuiteAxis>& axis, const AllScores& scores) {
  std::string html = fmt::format("<section id=\"{0}\"><h2>{1}</h2>\n", id, title);
  for (const LeaderboardScore& score : leaderboard_scores())
    html += methods_table(
        board, fmt::format("{}, % of loops with {:g} % interval", score.title, 100 * board.confidence), axis,
        scores, [&](const PooledScores& entry) { return score_html(entry, score); });
  return html + "</section>\n";
}

/// Delays by plant, of the families in which methods watched moving windows; nothing without one.
std::string delays_section(const Leaderboard& board) {
  std::string tables;
  for (std::size_t family = 0; family < board.families.size(); ++family) {
    const std::vector<const CellScores*> cells = monitored_cells(board, family);
    if (cells.empty())
      continue;
    std::vector<HtmlTable::Column> columns{{"Method", HtmlTable::Align::left}};
    for (const CellScores* const cell : cells)
      columns.push_back({html_text(plant_and_unit(board, *cell))});
    HtmlTable table(fmt::format("{}: {}", html_text(board.families[family].name), kDelayTitle), columns);
    for (std::size_t method = 0; method < board.methods.size(); ++method) {
      std::vector<std::string> row{html_text(label_of(board.methods[method]))};
      for (const CellScores* const cell : cells)
        row.push_back(delay_words(cell->methods[method]));
      table.row(row);
    }
    tables += table.html();
  }
  return tables.empty()
             ? ""
             : fmt::format("<section id=\"delays\"><h2>How long it takes</h2>\n{}</section>\n", tables);
}

std::string passed_html(const PooledScores& scores) {
  if (scores.cells == 0)
    return "<span class=\"none\">&ndash;</span>";
  std::string html;
  for (const LeaderboardTask task : kLeaderboardTasks)
    html += passes(scores, task) ? fmt::format("<span class=\"yes\">{}</span>", letter_of(task))
                                 : "<span class=\"none\">&middot;</span>";
  return html;
}

std::string passed_section(const Leaderboard& board) {
  std::string html = "<section id=\"passed\"><h2>Who passes what</h2>\n";
  html += methods_table(board, "Detection (D), location (L) and source (S) of each family", board.families,
                        board.by_family, passed_html);
  html += "<ul>\n";
  for (const LeaderboardTask task : kLeaderboardTasks) {
    const std::vector<std::string> nobody = passed_by_nobody(board, task);
    html += fmt::format("<li>{}: {}</li>\n", to_string(task),
                        nobody.empty() ? "every family is passed by some method"
                                       : fmt::format("nobody passes {}", fmt::join(nobody, ", ")));
  }
  html += "</ul>\n";
  for (const std::string& sentence : legend_sentences(board))
    html += fmt::format("<p>{}</p>\n", html_text(sentence));
  return fmt::format("{}</section>\n", html);
}

std::string figure_section(const Leaderboard& board) {
  return fmt::format("<section id=\"figure\"><h2>Detection and false alarms</h2>\n{}</section>\n",
                     figure_html(leaderboard_figure(board)));
}

std::string families_section(const Leaderboard& board) {
  HtmlTable table("What is done to the loops",
                  {{"Family", HtmlTable::Align::left}, {"Experiments", HtmlTable::Align::text}});
  for (const SuiteAxis& family : board.families)
    table.row({html_text(family.name), html_text(family.title)});
  HtmlTable plants("On which plants", {{"Plant", HtmlTable::Align::left}, {"Study", HtmlTable::Align::text}});
  for (const SuiteAxis& plant : board.plants)
    plants.row({html_text(plant.name), html_text(plant.title)});
  return fmt::format("<section id=\"families\"><h2>Families and plants</h2>\n{}{}</section>\n", table.html(),
                     plants.html());
}

std::string cells_section(const Leaderboard& board) {
  HtmlTable table("Each cell is an archive of its own, PLANT.FAMILY.h5",
                  {{"Cell", HtmlTable::Align::left},
                   {"Experiments"},
                   {"Infeasible"},
                   {"Failed"},
                   {"Seed"},
                   {"Not run", HtmlTable::Align::text}});
  for (const CellScores& cell : board.cells)
    table.row({fmt::format("{}.{}", html_text(board.plants[cell.plant].name),
                           html_text(board.families[cell.family].name)),
               fmt::to_string(cell.experiments), fmt::to_string(cell.infeasible), fmt::to_string(cell.failed),
               fmt::to_string(cell.seed), html_text(cell.trouble)});
  return fmt::format("<section id=\"cells\"><h2>Cells</h2>\n{}</section>\n", table.html());
}

std::string silences_section(const Leaderboard& board) {
  HtmlTable table("Loops without a verdict, and why the first of them has none",
                  {{"Method", HtmlTable::Align::left}, {"Loops"}, {"Of"}, {"Why", HtmlTable::Align::text}});
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (const PooledScores& scores = board.overall[method]; !scores.reason.empty()) {
      const Rate* const answered = scores.of("answered");
      table.row({html_text(board.methods[method]), fmt::to_string(answered->total - answered->hits),
                 fmt::to_string(answered->total), html_text(scores.reason)});
    }
  std::string legend;
  for (const LeaderboardScore& score : leaderboard_scores())
    for (const MethodRateInfo& info : method_rate_infos())
      if (score.rate == info.name)
        legend += fmt::format("<li><strong>{}</strong>: {}</li>\n", score.title, html_text(info.meaning));
  return fmt::format(
      "<section id=\"silences\"><h2>No verdict</h2>\n{}<p>What is counted:</p><ul>{}</ul></section>\n",
      table.html(), legend);
}

}  // namespace

std::string leaderboard_html(const Leaderboard& board) {
  const std::string body =
      passed_section(board) + figure_section(board) +
      scores_section(board, "by-family", "By family, pooled over the plants", board.families,
                     board.by_family) +
      scores_section(board, "by-plant", "By plant, pooled over the families", board.plants, board.by_plant) +
      delays_section(board) + silences_section(board) + families_section(board) + cells_section(board);
  return html_page({fmt::format("suite {} {}", board.suite, board.version),
                    fmt::format("Suite {} {}", html_text(board.suite), html_text(board.version)),
                    fmt::format("<p>{}: {}.</p>\n", html_text(board.title), size_text(board)),
                    "Made by <code>mpmbench suite</code>.", board.program},
                   body);
}

}  // namespace mpm
