#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/suite/leaderboard_output.hpp"
#include "results/suite/leaderboard_words.hpp"
#include "results/text/text_table.hpp"

namespace mpm {
namespace {

constexpr std::size_t kTextWidth = 120;

/// Columns of numbers that fit into kTextWidth beside the names of the methods.
constexpr std::size_t kColumnsAbreast = 6;
constexpr std::size_t kDelaysAbreast = 4;

std::string score_text(const PooledScores& scores, const LeaderboardScore& score) {
  const Rate* const rate = scores.of(score.rate);
  if (rate == nullptr || rate->total == 0)
    return "-";
  return fmt::format("{:.0f} [{:.0f}, {:.0f}]{}", 100 * rate->value, 100 * rate->interval.lower,
                     100 * rate->interval.upper, marks_of(scores));
}

/// A sentence under a name.
std::string item_text(const std::string& name, const std::string& sentence) {
  return wrapped(fmt::format("- {}: {}", name, sentence), kTextWidth, "  ");
}

std::string legend_text(const Leaderboard& board) {
  std::string text;
  for (const std::string& sentence : legend_sentences(board))
    text += wrapped(sentence, kTextWidth);
  return text;
}

/// The families, and all of them together.
std::vector<std::string> heads_of(const Leaderboard& board) {
  std::vector<std::string> heads;
  for (const SuiteAxis& family : board.families)
    heads.push_back(family.name);
  heads.emplace_back("all");
  return heads;
}

const PooledScores& scores_at(const Leaderboard& board, std::size_t method, std::size_t column) {
  return column < board.families.size() ? board.by_family[method][column] : board.overall[method];
}

/// One row a method, the columns in blocks of `abreast`; `cell` makes the entry of a method and a column.
std::string blocks_text(const Leaderboard& board, const std::string& title,
                        const std::vector<std::string>& heads, std::size_t abreast, const auto& cell) {
  std::string text;
  for (std::size_t first = 0; first < heads.size(); first += abreast) {
    const std::size_t last = std::min(first + abreast, heads.size());
    TextTable table;
    TextTable::Row head{""};
    head.insert(head.end(), heads.begin() + static_cast<std::ptrdiff_t>(first),
                heads.begin() + static_cast<std::ptrdiff_t>(last));
    table.add(head);
    for (std::size_t method = 0; method < board.methods.size(); ++method) {
      TextTable::Row row{label_of(board.methods[method])};
      for (std::size_t column = first; column < last; ++column)
        row.push_back(cell(method, column));
      table.add(row);
    }
    text += fmt::format("\n{}{}\n{}", title, first == 0 ? "" : " (continued)", table.text());
  }
  return text;
}

/// The same with a column for each family and one for all of them; `cell` makes the entries from the scores.
std::string families_text(const Leaderboard& board, const std::string& title, const auto& cell) {
  return blocks_text(
      board, title, heads_of(board), kColumnsAbreast,
      [&](std::size_t method, std::size_t column) { return cell(scores_at(board, method, column)); });
}

/// The delays of the families in which methods watched moving windows, a column a plant.
std::string delays_text(const Leaderboard& board) {
  std::string text;
  for (std::size_t family = 0; family < board.families.size(); ++family) {
    const std::vector<const CellScores*> cells = monitored_cells(board, family);
    std::vector<std::string> heads;
    for (const CellScores* const cell : cells)
      heads.push_back(plant_and_unit(board, *cell));
    text += blocks_text(
        board, fmt::format("{}: {}", board.families[family].name, kDelayTitle), heads, kDelaysAbreast,
        [&](std::size_t method, std::size_t column) { return delay_words(cells[column]->methods[method]); });
  }
  return text;
}

std::string passed_text(const PooledScores& scores) {
  if (scores.cells == 0)
    return "-";
  std::string text;
  for (const LeaderboardTask task : kLeaderboardTasks)
    text += passes(scores, task) ? letter_of(task) : '.';
  return text;
}

/// The tables of shares of the reference, a column for each family of its own; nothing without one.
std::string reference_text(const Leaderboard& board) {
  if (!has_reference(board))
    return "";
  std::vector<std::string> heads;
  std::vector<std::size_t> families;
  for (std::size_t family = 0; family < board.families.size(); ++family)
    if (board.families[family].has_reference) {
      heads.push_back(board.families[family].name);
      families.push_back(family);
    }
  std::string text;
  const std::vector<LeaderboardScore> known = leaderboard_scores();
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i].low_is_good)
      text += blocks_text(board, fmt::format("{}, % of the reference", known[i].title), heads,
                          kColumnsAbreast, [&](std::size_t method, std::size_t column) -> std::string {
                            const double share =
                                board.by_family[method][families[column]].shares_of_ceiling[i];
                            return std::isnan(share) ? "-" : fmt::format("{:.0f}", 100 * share);
                          });
  return text;
}

std::string nobody_text(const Leaderboard& board) {
  std::string text;
  for (const LeaderboardTask task : kLeaderboardTasks) {
    const std::vector<std::string> families = passed_by_nobody(board, task);
    text += fmt::format("{}: {}\n", to_string(task),
                        families.empty() ? "every family is passed by some method"
                                         : fmt::format("nobody passes {}", fmt::join(families, ", ")));
  }
  return text;
}

std::string troubles_text(const Leaderboard& board) {
  std::string text;
  for (const CellScores& cell : board.cells)
    if (!cell.trouble.empty())
      text += item_text(fmt::format("{}.{}", board.plants[cell.plant].name, board.families[cell.family].name),
                        cell.trouble);
  return text.empty() ? text : fmt::format("\nnot run\n{}", text);
}

std::string silences_text(const Leaderboard& board) {
  std::string text;
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    const PooledScores& scores = board.overall[method];
    if (scores.reason.empty())
      continue;
    const Rate* const answered = scores.of("answered");
    text += item_text(board.methods[method],
                      fmt::format("{} of {} loops, the first because: {}", answered->total - answered->hits,
                                  answered->total, scores.reason));
  }
  return text.empty() ? text : fmt::format("\nno verdict on\n{}", text);
}

}  // namespace

std::string leaderboard_text(const Leaderboard& board) {
  std::string text =
      fmt::format("{} {}: {}\n{}; % of loops [{:g} % interval], pooled over the plants\n", board.suite,
                  board.version, board.title, size_text(board), 100 * board.confidence);
  text += families_text(board, "passed: D detection, L location, S source", passed_text);
  for (const LeaderboardScore& score : leaderboard_scores())
    text += families_text(board, std::string(score.title),
                          [&](const PooledScores& scores) { return score_text(scores, score); });
  text += delays_text(board);
  text += reference_text(board);
  return fmt::format("{}\n{}\n{}{}{}", text, legend_text(board), nobody_text(board), silences_text(board),
                     troubles_text(board));
}

}  // namespace mpm
