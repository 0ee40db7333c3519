#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

using AllScores = std::vector<std::vector<PooledScores>>;  // [method][column]

/// Shows a share on a ground that is deeper for a higher share. Its marks: '*' for too many false alarms, '~'
/// for verdicts on part of the loops only.
Cell score_cell(const PooledScores& scores, const RateRow& row) {
  const Rate& rate = scores.rates.of(row);
  if (rate.total == 0)
    return Number{};
  Cell cell = number(rate, NumberForm::whole_percent);
  cell.mark = fmt::format("{}{}", scores.too_many_false_alarms() ? "*" : "", part_mark(scores));
  cell.hover = fmt::format("{} of {} loops", rate.hits, rate.total);
  cell.ground = rate.value;
  cell.low_is_good = row.low_is_good;
  return cell;
}

const char* letter_of(LeaderboardTask task) {
  return task == LeaderboardTask::detection ? "D" : task == LeaderboardTask::location ? "L" : "S";
}

/// Shows which tasks are passed: "DL.".
Cell passed_cell(const PooledScores& scores) {
  if (scores.cells == 0)
    return Number{};
  std::string letters;
  for (const LeaderboardTask task : kLeaderboardTasks)
    letters += passes(scores, task) ? strong(letter_of(task)) : ".";
  return letters;
}

/// Makes a table with one row per method and one column per name; `cell` makes the entry of a method and a
/// column.
Table methods_table(const Leaderboard& board, std::string caption, const std::vector<std::string>& heads,
                    const auto& cell) {
  std::vector<Table::Column> columns{{"Method", Table::Align::left}};
  for (const std::string& head : heads)
    columns.push_back({as_label(head)});
  Table table(std::move(caption), std::move(columns));
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    std::vector<Cell> cells{row_name(board, method)};
    for (std::size_t column = 0; column < heads.size(); ++column)
      cells.push_back(cell(method, column));
    table.row(std::move(cells));
  }
  return table;
}

/// Makes a table with a column for each plant or family, and one for all of them; `cell` makes an entry from
/// scores.
Table axis_table(const Leaderboard& board, std::string caption, const std::vector<SuiteAxis>& axis,
                 const AllScores& scores, const auto& cell) {
  std::vector<std::string> heads;
  for (const SuiteAxis& entry : axis)
    heads.push_back(entry.name);
  heads.emplace_back("all");
  return methods_table(board, std::move(caption), heads, [&](std::size_t method, std::size_t column) {
    return cell(column < axis.size() ? scores[method][column] : board.overall[method]);
  });
}

Table rate_table(const Leaderboard& board, const RateRow& row, const std::vector<SuiteAxis>& axis,
                 const AllScores& scores) {
  return axis_table(board,
                    fmt::format("{}, % of loops with {:g} % interval", row.heading, 100 * board.confidence),
                    axis, scores, [&row](const PooledScores& entry) { return score_cell(entry, row); });
}

Section scores_section(const Leaderboard& board, const char* id, const char* title,
                       const std::vector<SuiteAxis>& axis, const AllScores& scores) {
  Section section{.id = id, .title = title, .shown = Shown::full};
  for (const std::string_view name : leaderboard_rates())
    section.add(rate_table(board, row_of(rate_rows(), name), axis, scores));
  return section;
}

/// Explains the marks, and says which families are passed.
void add_legend(Section& section, const Leaderboard& board) {
  for (const LeaderboardTask task : kLeaderboardTasks) {
    const std::string nobody = listed(passed_by_nobody(board, task));
    section.say(
        fmt::format("{}: {}", to_string(task),
                    nobody.empty() ? "every family is passed by some method" : "nobody passes " + nobody));
  }
  section.say(fmt::format("* The interval of its own false alarms on healthy loops lies above {:g} %.",
                          100 * kMostFalseAlarms));
  section.say(fmt::format(
      "~ It gives verdicts on fewer than {:g} % of the loops: not on the same loops as the others.",
      100 * kFewestAnswers));
  section.say(fmt::format(
      "To pass, a method needs verdicts on {0:g} % of the loops and false alarms on at most {1:g} % of the "
      "healthy ones, and for D, {2:g} % of the faults with an impact flagged; for L, the affected CV named "
      "in {2:g} % of the flagged loops; for S, the right source named in {2:g} % of all loops with a fault.",
      100 * kFewestAnswers, 100 * kPassingFalseAlarms, 100 * kPassingShare));
  if (has_reference(board))
    section.say(
        fmt::format("The reference is the method {}, which knows the distributions of the study. It is shown "
                    "in the families that draw only what it knows; a method above 100 % of it was lucky.",
                    code(kReferenceMethod)));
  section.say(whose_intervals(board.in_worlds()));
}

Section passed_section(const Leaderboard& board) {
  Section section{.id = "passed", .title = "Who passes what", .shown = Shown::full};
  section.add(axis_table(board, "Passed: D detection, L location, S source", board.families, board.by_family,
                         passed_cell));
  add_legend(section, board);
  return section;
}

Cell estimate_cell(const PooledScores& scores, std::string_view name) {
  const Estimate& estimate = scores.estimates[name];
  if (estimate.count == 0)
    return Number{};
  Cell cell = Number{estimate.value, NumberForm::whole_percent, estimate.interval};
  cell.hover = fmt::format("{} loops", estimate.count);
  cell.ground = estimate.value;
  cell.mark = part_mark(scores);
  return cell;
}

/// For a suite of worlds: which method tells the source of a fault, and which names the channel worth a
/// repair.
Section ranking_section(const Leaderboard& board) {
  Section section{.id = "ranking", .title = "Who is right in worlds", .shown = Shown::full};
  if (!board.in_worlds())
    return section;
  section.add(rate_table(board, row_of(rate_rows(), kRankingSource), board.families, board.by_family));
  for (const std::string_view name : {kRankingRepair, std::string_view("repair_gain_share")})
    section.add(axis_table(
        board, fmt::format("{}, mean in % with {:g} % interval", heading_of(name), 100 * board.confidence),
        board.families, board.by_family,
        [name](const PooledScores& scores) { return estimate_cell(scores, name); }));
  return section;
}

/// Formats a number with `digits` digits, but always with all digits before the point: 1616, not 1.62e+03.
std::string plain_number(double value, int digits) {
  return std::isinf(value)                      ? "never"
         : value + 0.5 < std::pow(10.0, digits) ? fmt::format("{:.{}g}", value, digits)
                                                : fmt::format("{:.0f}", value);
}

/// The median delay of a method with its interval, and its false alarms a day: "94 (76 to 103); 0".
Cell delay_cell(const MethodScores& scores) {
  const Estimate &delay = scores.estimates["detection_delay"],
                 &alarms = scores.estimates["false_alarms_a_day"];
  if (delay.count == 0 && alarms.count == 0)
    return Number{};
  std::string text = delay.count == 0 ? "-" : plain_number(delay.value, 3);
  if (delay.count > 0 && !std::isnan(delay.interval.lower))
    text += fmt::format(" ({} to {})", plain_number(delay.interval.lower, 3),
                        plain_number(delay.interval.upper, 3));
  return alarms.count == 0 ? text : text + "; " + plain_number(alarms.value, 2);
}

/// Shows delays by plant, for the families in which methods watched moving windows.
Section delays_section(const Leaderboard& board) {
  Section section{.id = "delays", .title = "How long it takes", .shown = Shown::full};
  for (std::size_t family = 0; family < board.families.size(); ++family) {
    std::vector<const CellScores*> cells;
    for (const CellScores& cell : board.cells)
      if (cell.family == family && cell.monitored && cell.trouble.empty())
        cells.push_back(&cell);
    std::sort(cells.begin(), cells.end(),
              [](const CellScores* a, const CellScores* b) { return a->plant < b->plant; });
    std::vector<std::string> heads;
    for (const CellScores* const cell : cells)
      heads.push_back(fmt::format("{} ({})", board.plants[cell->plant].name, cell->time_unit));
    if (!cells.empty())
      section.add(methods_table(board,
                                as_label(board.families[family].name) +
                                    ": median time from the onset to the end of the first flagged window, "
                                    "faults with an impact; false "
                                    "alarms a day",
                                heads, [&](std::size_t method, std::size_t column) {
                                  return delay_cell(cells[column]->methods[method]);
                                }));
  }
  return section;
}

/// Shows one table per score, with a column for each family that has a reference.
Section reference_section(const Leaderboard& board) {
  Section section{.id = "reference", .title = "Against the reference", .shown = Shown::full};
  std::vector<std::string> heads;
  std::vector<std::size_t> families;
  for (std::size_t family = 0; family < board.families.size(); ++family)
    if (board.families[family].has_reference) {
      heads.push_back(board.families[family].name);
      families.push_back(family);
    }
  const std::vector<std::string_view> known = leaderboard_rates();
  for (std::size_t i = 0; has_reference(board) && i < known.size(); ++i)
    if (!method_number(known[i]).low_is_good)
      section.add(methods_table(board, fmt::format("{}, % of the reference", heading_of(known[i])), heads,
                                [&](std::size_t method, std::size_t column) -> Cell {
                                  return Number{
                                      board.by_family[method][families[column]].shares_of_ceiling[i],
                                      NumberForm::whole_percent};
                                }));
  return section;
}

/// Says which methods gave no verdict on which loops, and which cells were not run.
Section silences_section(const Leaderboard& board) {
  Section section{.id = "silences", .title = "No verdict", .shown = Shown::full};
  Sentences sentences;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (const PooledScores& scores = board.overall[method]; !scores.reason.empty()) {
      const Rate& answered = scores["answered"];
      sentences.words.push_back(fmt::format("{}: {} of {} loops, the first because: {}",
                                            as_label(board.methods[method]), answered.total - answered.hits,
                                            answered.total, as_label(scores.reason)));
    }
  for (const CellScores& cell : board.cells)
    if (!cell.trouble.empty())
      sentences.words.push_back(fmt::format("{}.{}: not run: {}", as_label(board.plants[cell.plant].name),
                                            as_label(board.families[cell.family].name),
                                            as_label(cell.trouble)));
  if (!sentences.words.empty())
    section.add(std::move(sentences));
  return section;
}

/// Explains what is counted, and on which loops; only on the page.
Section cells_section(const Leaderboard& board) {
  Section section{.id = "cells", .title = "Families, plants and cells", .shown = Shown::page};
  Sentences counted;
  std::vector<std::string_view> shown = leaderboard_rates();
  if (board.in_worlds())
    shown.insert(shown.end(), {kRankingSource, kRankingRepair, "repair_gain_share"});
  for (const std::string_view name : shown)
    counted.words.push_back(
        fmt::format("{}: {}", strong(heading_of(name)), as_label(method_number(name).meaning)));
  section.add(std::move(counted));
  const auto axis_table = [&](const char* caption, const char* what, const std::vector<SuiteAxis>& axis) {
    Table table(caption, {{what, Table::Align::left}, {"", Table::Align::text}});
    for (const SuiteAxis& entry : axis)
      table.row({as_label(entry.name), as_label(entry.title)});
    section.add(std::move(table));
  };
  axis_table("What is done to the loops", "Family", board.families);
  axis_table("On which plants", "Plant", board.plants);
  Table table("Each cell is an archive of its own, PLANT.FAMILY.h5",
              {{"Cell", Table::Align::left}, {"Experiments"}, {"Infeasible"}, {"Failed"}, {"Seed"}});
  for (const CellScores& cell : board.cells)
    table.row({as_label(board.plants[cell.plant].name + "." + board.families[cell.family].name),
               cell.experiments, cell.infeasible, cell.failed, fmt::to_string(cell.seed)});
  section.add(std::move(table));
  return section;
}

}  // namespace

const char* part_mark(const PooledScores& scores) {
  return scores.answers_in_part() ? "~" : "";
}

std::string label_of(const std::string& method) {
  return method == kReferenceMethod ? "reference" : method;
}

Document leaderboard_document(const Leaderboard& board) {
  std::int64_t experiments = 0, cells = 0;
  for (const CellScores& cell : board.cells) {
    experiments += cell.experiments;
    cells += cell.trouble.empty() ? 1 : 0;
  }
  const std::string name = fmt::format("{} {}", board.suite, board.version);
  Document document{
      name, as_label("Suite " + name),
      fmt::format("{}: {} ({}, {}), {} experiments, seed {}.{}", as_label(board.title),
                  counted(cells, "cell"), counted(std::ssize(board.plants), "plant"),
                  counted(std::ssize(board.families), "family", "families"), experiments, board.seed,
                  board.finished_by.empty()
                      ? ""
                      : fmt::format(" With the finished run of {}.", as_label(board.finished_by))),
      "Made by " + code("mpmbench suite") + ".", board.program};
  Section figure{.id = "figure", .title = "The table as a figure", .shown = Shown::page};
  figure.add(leaderboard_figure(board));
  Section by_plant =
      scores_section(board, "by-plant", "By plant, pooled over the families", board.plants, board.by_plant);
  by_plant.shown = Shown::page;
  for (Section section :
       {standing_section(board), questions_section(board), information_section(board),
        probabilities_section(board), probabilities_by_family_section(board), confusions_section(board),
        std::move(figure), ranking_section(board), passed_section(board),
        scores_section(board, "by-family", "By family, pooled over the plants", board.families,
                       board.by_family),
        std::move(by_plant), delays_section(board), reference_section(board), silences_section(board),
        cells_section(board)})
    if (!section.content.empty())
      document.sections.push_back(std::move(section));
  return document;
}

}  // namespace mpm
