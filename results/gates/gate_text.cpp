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

std::string changes_heading(const BaselineChanges& question) {
  const JudgementChanges& changes = question.changes;
  const McNemarTest test = changes.test();
  return fmt::format("{}: {} lost, {} gained among {} experiments, p = {:.3g} (two-sided {:.3g})\n",
                     question.title, changes.lost.size(), changes.gained.size(), changes.pairs, test.p_worse,
                     test.p_two_sided);
}

/// The keys that differ, a line each: "  diagnosis.mpm_threshold: 0.1 -> 0.9".
std::string edited_text(const BaselineComparison& baseline) {
  if (baseline.edited.empty())
    return "";
  std::string text = "the study was edited since:\n";
  for (const StudyDifference& each : baseline.edited)
    text += fmt::format("  {}: {} -> {}\n", each.key, each.before.empty() ? "not there" : each.before,
                        each.now.empty() ? "not there" : each.now);
  return text;
}

std::string baseline_text(const BaselineComparison& baseline) {
  std::string text = fmt::format("\nagainst the baseline {} ({}):\n{}", baseline.path, baseline.run_by,
                                 edited_text(baseline));
  for (const BaselineChanges& each : baseline.questions)
    text += changes_heading(each) + changes_text(each.changes);
  return text;
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
  std::string text = (check.title.empty() ? "" : check.title + "\n\n") + gate_table(check);
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
