#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/source_forecast.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

constexpr const char* kFrequencies = "frequencies of the suite";
const Pen kStated{colour::kBlue, Dash::solid, Mark::dot, 1.2, 0.8};
const Pen kRightAsStated{colour::kGrey, Dash::dashed};

Cell score_of(const PooledScores& scores, std::string_view name) {
  const Estimate& found = scores.estimates[name];
  if (found.count == 0)
    return Number{};
  Cell cell = fixed(found.value, found.interval);
  cell.mark = part_mark(scores);
  return cell;
}

bool every_cell(const CellScores&) {
  return true;
}

Table scores_table(const Leaderboard& board) {
  std::vector<Table::Column> heads{{"Method", Table::Align::left}};
  for (const std::string_view name : probability_scores())
    heads.push_back({heading_of(name)});
  heads.insert(heads.end(), {{"Skill, logarithmic"}, {"Skill, Brier"}, {"Loops"}});
  Table table(fmt::format("All loops with a verdict, with {:g} % interval", 100 * board.confidence),
              std::move(heads));
  for (const std::size_t method : stating_methods(board)) {
    const PooledScores& scores = board.overall[method];
    std::vector<Cell> cells{row_name(board, method)};
    for (const std::string_view name : probability_scores())
      cells.push_back(score_of(scores, name));
    const ForecastSkill skill = forecast_skill(board, method);
    cells.insert(cells.end(), {fixed(skill.log_score), fixed(skill.brier_score), scores.reliability.count()});
    table.row(std::move(cells));
  }
  const ForecastScores forecast = frequency_scores(board, every_cell);
  table.row({kFrequencies, fixed(forecast.log_score), fixed(forecast.brier_score), "", fixed(0.0), fixed(0.0),
             forecast.loops});
  return table;
}

/// The probabilities that the reference states for every loop: "none 36 %, mpm 24 %, ...".
std::string frequencies_text(const SourceProbabilities& frequencies) {
  std::string text;
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    text +=
        fmt::format("{}{} {:.0f} %", i == 0 ? "" : ", ", code(kWords<FaultSource>[i]), 100 * frequencies[i]);
  return text;
}

Panel reliability_panel(const Leaderboard& board, std::size_t method) {
  const std::vector<double> ticks{0, 20, 40, 60, 80, 100};
  PanelScript panel(fmt::format("reliability_{}", method), as_label(board.methods[method]),
                    {.label = "stated, %", .lower = -2, .upper = 102, .ticks = ticks},
                    {.label = "is the truth, %", .lower = -2, .upper = 102, .ticks = ticks});
  panel.line({0, 100}, {0, 100}, kRightAsStated);
  std::vector<Whisker> points;
  for (const Reliability::Bin& bin : board.overall[method].reliability.bins())
    if (bin.count > 0) {
      const Rate right = rate(bin.right, bin.count, board.confidence);
      const double stated = 100 * bin.stated / static_cast<double>(bin.count);
      points.push_back({stated, 100 * right.value, 100 * right.interval.lower, 100 * right.interval.upper,
                        fmt::format("stated {:.1f} %, true {:.1f} % ({:.1f} to {:.1f}), {} of {} loops",
                                    stated, 100 * right.value, 100 * right.interval.lower,
                                    100 * right.interval.upper, bin.right, bin.count)});
    }
  panel.upright_whiskers(points, kStated);
  return panel.finish(fmt::format("Reliability of {}: how often the likeliest source is the truth against "
                                  "the probability stated for it, one point for each bin of a tenth.",
                                  board.methods[method]),
                      220.0);
}

Figure reliability_figure(const Leaderboard& board) {
  Figure figure;
  figure.name = "reliability";
  figure.caption = fmt::format(
      "Reliability: how often the source that a method states as the likeliest is the truth, by its stated "
      "probability, in bins of a tenth, with Wilson's {:g} % intervals, as if loops were independent. On the "
      "dashed line a method is right as often as it says; below the line it is overconfident.",
      100 * board.confidence);
  figure.legend = {{"bin of a tenth", kStated}, {"as often as stated", kRightAsStated}};
  for (const std::size_t method : stating_methods(board))
    figure.panels.push_back(reliability_panel(board, method));
  return figure;
}

/// Makes a table of the numbers of the figure, with a column for each bin that some method uses.
Table bins_table(const Leaderboard& board) {
  std::vector<std::size_t> used;
  for (std::size_t bin = 0; bin < Reliability::kBins; ++bin)
    for (const PooledScores& scores : board.overall)
      if (scores.reliability.bins()[bin].count > 0 && (used.empty() || used.back() != bin))
        used.push_back(bin);
  std::vector<Table::Column> heads{{"Method", Table::Align::left}};
  for (const std::size_t bin : used)
    heads.push_back({fmt::format("{} to {} %", 10 * bin, 10 * (bin + 1))});
  Table table(
      "How often the likeliest source is the truth, by its stated probability: % with interval, and the "
      "number of loops",
      std::move(heads));
  for (const std::size_t method : stating_methods(board)) {
    std::vector<Cell> cells{row_name(board, method)};
    for (const std::size_t bin : used) {
      const Reliability::Bin& of = board.overall[method].reliability.bins()[bin];
      Cell cell = number_of(rate(of.right, of.count, board.confidence), NumberForm::whole_percent);
      if (of.count > 0)
        cell.hover =
            fmt::format("stated {:.1f} % on average", 100 * of.stated / static_cast<double>(of.count));
      cells.push_back(std::move(cell));
    }
    table.row(std::move(cells));
  }
  return table;
}

}  // namespace

std::vector<std::string_view> probability_scores() {
  return {"log_score", "brier_score", "calibration_error"};
}

std::vector<std::size_t> stating_methods(const Leaderboard& board) {
  std::vector<std::size_t> methods;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (states_probabilities(board, method))
      methods.push_back(method);
  std::stable_sort(methods.begin(), methods.end(), [&board](std::size_t a, std::size_t b) {
    return board.overall[a].estimates["log_score"].value < board.overall[b].estimates["log_score"].value;
  });
  return methods;
}

Section probabilities_section(const Leaderboard& board) {
  Section section{"probabilities", "What stated probabilities are worth"};
  const std::optional<SourceProbabilities> frequencies = source_frequencies(board);
  if (!frequencies || stating_methods(board).empty())
    return section;
  section.add(scores_table(board));
  section.say(
      fmt::format("Low scores are good. The frequencies of the suite are a forecast without a record: it "
                  "states the shares of the sources on this board ({}) for every loop. Skill: 1 less the "
                  "score over the score of this forecast on the same loops.",
                  frequencies_text(*frequencies)));
  section.add(reliability_figure(board));
  return section;
}

Section probabilities_by_family_section(const Leaderboard& board) {
  Section section{.id = "probabilities-by-family",
                  .title = "Stated probabilities by family and bin",
                  .shown = Shown::full};
  const std::vector<std::size_t> stating = stating_methods(board);
  if (stating.empty())
    return section;
  for (const std::string_view name : probability_scores()) {
    std::vector<Table::Column> heads{{"Method", Table::Align::left}};
    for (const SuiteAxis& family : board.families)
      heads.push_back({as_label(family.name)});
    Table table(heading_of(name), std::move(heads));
    for (const std::size_t method : stating) {
      std::vector<Cell> cells{row_name(board, method)};
      for (const PooledScores& scores : board.by_family[method])
        cells.push_back(score_of(scores, name));
      table.row(std::move(cells));
    }
    std::vector<Cell> reference{kFrequencies};
    for (std::size_t family = 0; family < board.families.size(); ++family) {
      const ForecastScores scores =
          frequency_scores(board, [family](const CellScores& cell) { return cell.family == family; });
      reference.emplace_back(fixed(name == "log_score" ? scores.log_score : scores.brier_score));
    }
    if (name != "calibration_error")
      table.row(std::move(reference));
    section.add(std::move(table));
  }
  section.add(bins_table(board));
  Sentences meanings;
  for (const std::string_view name : probability_scores())
    meanings.words.push_back(
        fmt::format("{}: {}", strong(heading_of(name)), as_label(method_number(name).meaning)));
  section.add(std::move(meanings));
  return section;
}

}  // namespace mpm
