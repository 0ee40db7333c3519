#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  return fmt::format("{}: {} lost, {} gained among {} experiments, p = {:.3g}, corrected {:.3g}\n",
                     question.title, changes.lost.size(), changes.gained.size(), changes.pairs,
                     changes.test().p_worse, question.p_worse);
}

/// The keys that differ, a line each, and the methods that are in one of the two only.
std::string edited_text(const BaselineComparison& baseline) {
  std::string text = baseline.edited.empty() ? "" : "changed since:\n";
  for (const StudyDifference& each : baseline.edited)
    text += fmt::format("  {}: {}\n", each.key, difference_text(each));
  if (!baseline.not_compared.empty())
    text += fmt::format("not compared, since only one of the two has it: {}\n",
                        fmt::join(baseline.not_compared, ", "));
  return text;
}

std::string baseline_text(const BaselineComparison& baseline) {
  std::string text = fmt::format("\nagainst the baseline {} ({}):\n{}", baseline.path, baseline.run_by,
                                 edited_text(baseline));
  std::vector<std::string> unchanged;
  for (const BaselineChanges& each : baseline.questions)
    if (each.changed())
      text += changes_heading(each) + changes_text(each.changes);
    else
      unchanged.push_back(each.name);
  if (!unchanged.empty())
    text += fmt::format("no verdict changed: {}\n", fmt::join(unchanged, ", "));
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
