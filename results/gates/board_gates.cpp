#include "results/gates/board_gates.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/leaderboard_standing.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_table.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Makes a board of the methods of the run, together with those of the finished board if there is one.
JoinedBoard joined(const BoardRun& run, double confidence) {
  const FinishedBoard& board = run.board;
  if (run.finished)
    return join_boards(run.suite, board.methods, board.program, board.cells, *run.finished, confidence);
  return {make_leaderboard(run.suite, board.methods, board.program, board.cells, confidence)};
}

/// Adds the scores of a method. `family` is "" for all loops, or "FAMILY." for one family.
void add_scores(const std::string& method, const std::string& family, const PooledScores& scores,
                std::vector<Finding>& findings) {
  for (const RateRow& row : rate_rows())
    findings.push_back(method_finding(method, row, family).with(scores.rates.of(row)));
  for (const EstimateRow& row : estimate_rows())
    if (row.of == StudyFeature::worlds || row.of == StudyFeature::calibrated_worlds) {
      const Estimate& found = scores.estimates.of(row);
      findings.push_back(method_finding(method, row, family).with(found.value, found.interval, found.count));
    }
}

void add_standing(const Leaderboard& board, std::size_t method, std::vector<Finding>& findings) {
  const std::optional<Standing> standing = standing_of(board, method);
  const auto add = [&](const char* name, const char* meaning, double value) {
    Finding finding = method_finding(board.methods[method], name, name, meaning);
    finding.has_interval = false;
    findings.push_back(
        finding.with(value, {kNaN, kNaN}, standing ? static_cast<std::int64_t>(standing->duels.size()) : 0));
  };
  add("place", "its place among the methods of the board, at 5 % false alarms",
      standing ? standing->place : kNaN);
  add("beats", "number of methods of the board that it beats by more than chance, on the same loops",
      standing ? standing->won() : kNaN);
  add("loses_to", "number of methods of the board that beat it by more than chance, on the same loops",
      standing ? standing->lost() : kNaN);
}

/// A question that a baseline is compared on. It belongs to a rate, whose hits are the right or the wrong
/// answers.
struct BoardQuestion {
  const char* name;
  std::string_view rate;
  bool hit_is_right = true;
};

constexpr BoardQuestion kBoardQuestions[] = {{"quiet", "false_alarm_healthy", false},
                                             {"detected", "detected_impact"},
                                             {"located", "located"},
                                             {"source", "source_all"}};

/// A cell of a run, and what one method said about its loops.
struct MethodLoops {
  const CellScores& cell;
  const MethodScores& scores;

  Correctness ask(const BoardQuestion& question, std::size_t loop) const {
    const std::optional<LoopOutcome>& said = scores.outcomes[loop];
    const std::optional<bool> hit =
        said ? row_of(rate_rows(), question.rate).ask({scores.scope, *cell.truths[loop], *said})
             : std::nullopt;
    if (!hit)
      return Correctness::not_judged;
    return *hit == question.hit_is_right ? Correctness::right : Correctness::wrong;
  }
};

/// Cells of two runs that have the same loops.
struct PairedCell {
  std::string name;
  const CellScores &before, &now;
};

std::vector<PairedCell> paired_cells(const BoardRun& run, const FinishedBoard& baseline,
                                     const std::string& where) {
  std::vector<PairedCell> pairs;
  for (const CellScores& cell : run.board.cells) {
    if (!cell.trouble.empty())
      continue;
    const std::string name = run.suite.name_of(cell.plant, cell.family);
    const CellScores* const found = baseline.same_cell(cell);
    if (found == nullptr)
      throw InputError(where, fmt::format("no results of the cell {}", name), "all cells that are checked");
    if (found->truths.size() < cell.truths.size() ||
        !std::equal(cell.worlds.begin(), cell.worlds.end(), found->worlds.begin()))
      throw InputError(where, fmt::format("{}: {} loops", name, found->truths.size()),
                       fmt::format("the {} loops that are checked", cell.truths.size()));
    pairs.push_back({name, *found, cell});
  }
  return pairs;
}

/// Compares one method in both runs, where it has these positions.
JudgementChanges changes_of(const std::vector<PairedCell>& cells, const BoardQuestion& question,
                            std::size_t place_before, std::size_t place_now) {
  JudgementChanges changes;
  int clusters = 0;
  for (const PairedCell& cell : cells) {
    const MethodLoops before{cell.before, cell.before.methods[place_before]};
    const MethodLoops now{cell.now, cell.now.methods[place_now]};
    int largest = -1;
    for (std::size_t loop = 0; loop < cell.now.truths.size(); ++loop) {
      const int world = cell.now.worlds[loop];
      changes.add(
          {static_cast<std::int64_t>(loop), before.ask(question, loop), now.ask(question, loop), cell.name},
          clusters + world);
      largest = std::max(largest, world);
    }
    clusters += largest + 2;  // world -1, the exact one, may occur
  }
  return changes;
}

BaselineComparison compare_boards(const BoardRun& run, const FinishedBoard& baseline,
                                  const std::string& path) {
  const std::string where = fmt::format("baseline {}", path);
  const std::vector<PairedCell> cells = paired_cells(run, baseline, where);
  BaselineComparison comparison{path, baseline.runner(), {}};
  std::vector<BaselineChanges> questions;
  bool in_common = false;
  for (std::size_t now = 0; now < run.board.methods.size(); ++now) {
    const std::string& method = run.board.methods[now];
    const auto found = std::find(baseline.methods.begin(), baseline.methods.end(), method);
    if (found == baseline.methods.end()) {
      comparison.not_compared.push_back(method);
      continue;
    }
    in_common = true;
    for (const BoardQuestion& question : kBoardQuestions) {
      JudgementChanges changes =
          changes_of(cells, question, static_cast<std::size_t>(found - baseline.methods.begin()), now);
      if (changes.pairs > 0)
        questions.push_back({fmt::format("{}.{}", method, question.name),
                             fmt::format("{}, {}", method, question.name), std::move(changes)});
    }
  }
  if (!in_common)
    throw InputError(
        where, fmt::format("{}", fmt::join(baseline.methods, ", ")),
        fmt::format("a run of one of the methods that are checked: {}", fmt::join(run.board.methods, ", ")));
  comparison.questions = correct_questions(std::move(questions));
  return comparison;
}

/// Counts the failures of a method on all cells that were run. The reason is that of the first loop without a
/// verdict, in a cell with a failure.
VerdictFailures failures_of(const FinishedBoard& board, std::size_t method) {
  VerdictFailures failures;
  for (const CellScores& cell : board.cells)
    if (cell.trouble.empty()) {
      const MethodScores& scores = cell.methods[method];
      failures.add(VerdictFailures{scores.failed, scores["answered"].hits + scores.failed,
                                   scores.failed > 0 ? scores.reason : ""});
    }
  return failures;
}

/// Judges the answers of the methods that this program does not have.
void judge_outside_methods(const FinishedBoard& board, double minimum, std::vector<GateResult>& results) {
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (!shipped_methods().has(board.methods[method]))
      if (auto answers = judge_answers(board.methods[method], failures_of(board, method), minimum))
        results.push_back(*std::move(answers));
}

/// Returns the findings on the methods of the run.
std::vector<Finding> board_findings(const BoardRun& run, const Leaderboard& board) {
  std::vector<Finding> findings;
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    const std::string& name = board.methods[method];
    if (std::find(run.board.methods.begin(), run.board.methods.end(), name) == run.board.methods.end())
      continue;
    add_scores(name, "", board.overall[method], findings);
    for (std::size_t family = 0; family < board.families.size(); ++family)
      add_scores(name, board.families[family].name + ".", board.by_family[method][family], findings);
    add_standing(board, method, findings);
  }
  return findings;
}

}  // namespace

std::vector<Finding> gate_findings(const BoardRun& run) {
  return board_findings(run, joined(run, kBoardConfidence).board);
}

GateCheck check_gates(const BoardRun& run, const GateFile& file, const FinishedBoard* baseline) {
  const Suite& suite = run.suite;
  std::int64_t experiments = 0, failed = 0, not_run = 0;
  for (const CellScores& cell : run.board.cells) {
    experiments += cell.experiments;
    failed += cell.failed;
    not_run += cell.trouble.empty() ? 0 : 1;
  }
  const auto cells = static_cast<std::int64_t>(run.board.cells.size());
  GateCheck check{
      .name = suite.name,
      .title = fmt::format("suite {} {}, seed {}: {} of {} cells, by {}", suite.name, suite.version,
                           suite.seed, cells, suite.cells.size(), run.board.runner()),
      .properties = {{"seed", fmt::format("{}", suite.seed)},
                     {"suite_version", suite.version},
                     {"mpmbench_version", run.board.program},
                     {"git_sha", run.board.revision}},
      .confidence = file.confidence.value_or(kBoardConfidence)};
  check.results = {
      judge_number("experiments", "number of experiments", static_cast<double>(experiments), experiments,
                   static_cast<double>(file.minimum_experiments), kInfinity),
      judge_number("failed", "number of experiments without a result", static_cast<double>(failed),
                   experiments, -kInfinity, static_cast<double>(file.maximum_failed)),
      judge_number("cells_not_run", "number of cells that could not be run", static_cast<double>(not_run),
                   cells, -kInfinity, 0.0)};
  judge_outside_methods(run.board, file.minimum_answered, check.results);
  if (file.baseline)
    check.baseline = compare_boards(run, *baseline, file.baseline->archive.string());
  const JoinedBoard joined_board = joined(run, check.confidence);
  for (const std::string& note : joined_board.notes)
    check.title += "\n" + note;
  return judge_gates(std::move(check), file, board_findings(run, joined_board.board));
}

}  // namespace mpm
