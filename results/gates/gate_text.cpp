#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "results/document/document_text.hpp"
#include "results/gates/gate_report.hpp"
#include "results/gates/gate_sentences.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

std::string gate_table(const GateCheck& check) {
  Table table("", {{"gate", Table::Align::left},
                   {"limit"},
                   {"judged by"},
                   {"measured"},
                   {fmt::format("{:g} % interval", 100.0 * check.confidence)},
                   {"count"},
                   {"margin"},
                   {"outcome", Table::Align::left}});
  for (const GateResult& result : check.results)
    table.row({as_label(result.gate.name), limit_text(result),
               result.gate.with_confidence ? "interval" : "value", measured_text(result),
               interval_text(result), result.measured.count, margin_text(result),
               std::string(to_string(result.outcome))});
  return table_text(table, kUnlimitedWidth);
}

std::string changes_heading(const char* question, const JudgementChanges& changes) {
  return fmt::format("{}: {} lost, {} gained among {} experiments, p = {:.3g} (two-sided {:.3g})\n", question,
                     changes.lost.size(), changes.gained.size(), changes.pairs, changes.test.p_worse,
                     changes.test.p_two_sided);
}

std::string baseline_text(const BaselineComparison& baseline) {
  std::string text;
  for (const BaselineChanges& each : baseline.questions)
    text += changes_heading(each.title, each.changes) + changes_text(each.changes);
  return fmt::format("\nagainst the baseline {} (mpmbench {} ({}), solver {}):\n", baseline.archive,
                     baseline.info.mpmbench_version,
                     baseline.info.git_sha.empty() ? "unknown revision" : baseline.info.git_sha,
                     baseline.info.solver) +
         text;
}

std::string verdict_line(const GateCheck& check) {
  const auto count = [&](GateOutcome outcome) {
    return std::count_if(check.results.begin(), check.results.end(),
                         [outcome](const GateResult& result) { return result.outcome == outcome; });
  };
  const auto inconclusive = count(GateOutcome::inconclusive);
  const char* counts_as =
      check.inconclusive == InconclusivePolicy::fail ? "fails the check" : "is let through";
  return fmt::format("\n{}: {} of {} gates pass, {} fail, {} inconclusive{}\n",
                     check.passed() ? "PASSED" : "FAILED", count(GateOutcome::pass), check.results.size(),
                     count(GateOutcome::fail), inconclusive,
                     inconclusive > 0 ? fmt::format(", which {}", counts_as) : "");
}

}  // namespace

std::string gates_text(const GateCheck& check) {
  std::string text = gate_table(check);
  std::string reasons;
  for (const GateResult& result : check.results)
    if (result.outcome != GateOutcome::pass)
      reasons += explanation(result, check.confidence) + "\n";
  if (!reasons.empty())
    text += "\n" + reasons;
  if (check.baseline)
    text += baseline_text(*check.baseline);
  return text + verdict_line(check);
}

}  // namespace mpm
