#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/document/document_text.hpp"
#include "results/gates/gate_document.hpp"
#include "results/gates/gate_report.hpp"
#include "results/gates/gate_sentences.hpp"

namespace mpm {
namespace {

std::string changes_heading(const BaselineChanges& question) {
  const JudgementChanges& changes = question.changes;
  return fmt::format("{}: {} lost, {} gained among {} experiments, p = {:.3g}, corrected {:.3g}\n",
                     question.title, changes.lost.size(), changes.gained.size(), changes.pairs,
                     changes.test().p_worse, question.p_worse);
}

/// Lists the keys that differ, one per line, and the methods that only one of the two runs has.
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

}  // namespace

std::string gates_text(const GateCheck& check) {
  std::string text =
      (check.title.empty() ? "" : check.title + "\n\n") + table_text(gate_table(check), kUnlimitedWidth);
  std::string reasons;
  for (const GateResult& result : check.results)
    if (result.outcome != GateOutcome::pass)
      reasons += explanation(result, check.confidence) + "\n";
  if (!reasons.empty())
    text += "\n" + reasons;
  if (check.baseline)
    text += baseline_text(*check.baseline);
  return text + "\n" + verdict_sentence(check) + "\n";
}

std::string stopped_text(const GateCheck& check) {
  if (check.passed())
    return "";
  std::string text;
  for (const GateResult& result : check.results)
    if (check.stops(result))
      text += explanation(result, check.confidence) + "\n";
  return text + verdict_sentence(check) + "\n";
}

}  // namespace mpm
