#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/source_confusions.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

/// Returns the kinds of which some method of the board has loops.
template <class Kind>
std::vector<Kind> used_by(const Leaderboard& board) {
  std::vector<Kind> used;
  for (const Kind kind : enumerators<Kind>())
    if (std::any_of(board.overall.begin(), board.overall.end(),
                    [kind](const PooledScores& scores) { return scores.confusions.of(kind) > 0; }))
      used.push_back(kind);
  return used;
}

/// Names an answer in a heading: "no answer".
std::string answer_head(AnsweredSource answer) {
  switch (answer) {
    case AnsweredSource::no_answer:
      return "no answer";
    case AnsweredSource::none:
      return "none (not flagged)";
    case AnsweredSource::unnamed:
      return "flagged, no source";
    default:
      return std::string(to_string(answer));
  }
}

Table confusions_table(const Leaderboard& board, std::size_t method, const std::vector<ToldSource>& truths,
                       const std::vector<AnsweredSource>& answers) {
  const SourceConfusions& confusions = board.overall[method].confusions;
  std::vector<Table::Column> heads{{"Truth", Table::Align::left}};
  for (const AnsweredSource answer : answers)
    heads.push_back({as_label(answer_head(answer))});
  heads.push_back({"loops"});
  Table table(fmt::format("{}: loops by truth (rows) and by answer (columns)", code(board.methods[method])),
              std::move(heads));
  for (const ToldSource truth : truths) {
    std::vector<Cell> cells{as_label(std::string(to_string(truth)))};
    for (const AnsweredSource answer : answers) {
      Cell cell = confusions.of(truth, answer);
      if (answer == right_answer(truth))
        cell.tone = Cell::Tone::strong;
      if (confusions.of(truth) > 0)
        cell.ground =
            static_cast<double>(confusions.of(truth, answer)) / static_cast<double>(confusions.of(truth));
      cells.push_back(std::move(cell));
    }
    cells.emplace_back(confusions.of(truth));
    table.row(std::move(cells));
  }
  return table;
}

}  // namespace

Section confusions_section(const Leaderboard& board) {
  Section section{.id = "confusions", .title = "What is taken for what", .shown = Shown::full};
  const std::vector<ToldSource> truths = used_by<ToldSource>(board);
  const std::vector<AnsweredSource> answers = used_by<AnsweredSource>(board);
  if (truths.empty())
    return section;
  section.say(
      "Loops that a method flags at its own threshold, and the source that it names. For a fault outside of "
      "the model (a sensor, a valve, or another), the rates count any of these sources, or none named, as "
      "right.");
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (board.overall[method].confusions.total() > 0)
      section.add(confusions_table(board, method, truths, answers));
  return section;
}

}  // namespace mpm
