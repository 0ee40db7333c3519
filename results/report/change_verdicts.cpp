#include <map>
#include <set>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/change_sections.hpp"
#include "results/report/html_table.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostChanges = 500;  // rows

/// What the method says, in short.
std::string answer_text(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  if (!said.answered())
    return said.reason.empty() ? "no verdict" : "no verdict: " + said.reason;
  if (!said.flagged)
    return "not flagged";
  const std::string cv = said.predicted_cv < 0 ? "" : " " + cv_name(study, said.predicted_cv);
  return fmt::format("flagged{}{}", cv,
                     said.predicted_source == FaultSource::none
                         ? ""
                         : fmt::format(" ({})", source_name(said.predicted_source)));
}

/// Which questions of one experiment became right, and which are right no more.
struct Changed {
  std::string lost, gained;
};

std::map<std::int64_t, Changed> changed_experiments(const MethodChange& method) {
  std::map<std::int64_t, Changed> experiments;
  const auto add = [](std::string& list, const JudgementPair& pair, const char* name) {
    const bool plain = pair.before != Correctness::not_judged && pair.now != Correctness::not_judged;
    list += fmt::format("{}{}{}", list.empty() ? "" : "; ", name,
                        plain ? "" : fmt::format(" ({}, {})", to_string(pair.before), to_string(pair.now)));
  };
  for (const VerdictChange& verdict : method.verdicts) {
    for (const JudgementPair& pair : verdict.changes.lost)
      add(experiments[pair.index].lost, pair, verdict.question->name);
    for (const JudgementPair& pair : verdict.changes.gained)
      add(experiments[pair.index].gained, pair, verdict.question->name);
  }
  return experiments;
}

/// The same experiment in both archives, without its loop.
struct LoopPair {
  ExperimentRecord before, now;
};

/// These experiments, by their index.
std::map<std::int64_t, LoopPair> loops_with(const ChangeInput& input, const std::set<std::int64_t>& indices) {
  std::map<std::int64_t, LoopPair> loops;
  each_in_both(records_of(input.before), records_of(input.now),
               [&](const ExperimentRecord& before, const ExperimentRecord& now) {
                 if (indices.count(now.draw.index) == 0)
                   return;
                 LoopPair& pair = loops.emplace(now.draw.index, LoopPair{before, now}).first->second;
                 for (ExperimentRecord* const record : {&pair.before, &pair.now}) {
                   record->loop.reset();
                   record->truth.reset();
                 }
               });
  return loops;
}

/// The experiments that have a row, of one method or several.
std::set<std::int64_t> shown_experiments(const ChangeInput& input) {
  std::set<std::int64_t> indices;
  std::size_t rows = 0;
  for (const MethodChange& method : input.methods)
    for (const auto& [index, changed] : changed_experiments(method))
      if (++rows <= kMostChanges)
        indices.insert(index);
  return indices;
}

std::string replay_cell(const ChangeInput& input, const ExperimentDraw& draw) {
  return fmt::format("{}<br><code>mpmbench replay {} {}</code><br><code>mpmbench replay {} {}</code>",
                     html_text(fault_text(input.now.study, draw)), html_text(input.before_file), draw.index,
                     html_text(input.now_file), draw.index);
}

std::string count_table(const ChangeInput& input) {
  HtmlTable table(
      "Each question to each method: how often the answer is right in both archives, right in A and not in "
      "B, and "
      "the reverse. An answer that is not judged any more is lost. p is that of McNemar&rsquo;s exact test, "
      "two-sided, and corrected by Holm for all rows.",
      {{"Question", HtmlTable::Align::left},
       {"Judged"},
       {"Right in both"},
       {"Right, then not"},
       {"Not, then right"},
       {"p"},
       {"p, corrected"}});
  for (const MethodChange& method : input.methods) {
    if (!method.changed())
      continue;
    table.group(html_text(method.name));
    for (const VerdictChange& verdict : method.verdicts)
      table.row({html_text(verdict.question->name), fmt::format("{}", verdict.changes.pairs),
                 fmt::format("{}", verdict.right_in_both), fmt::format("{}", verdict.changes.lost.size()),
                 fmt::format("{}", verdict.changes.gained.size()),
                 fmt::format("{:.2g}", verdict.changes.test.p_two_sided),
                 fmt::format("{:.2g}", verdict.p_holm)});
  }
  std::string html = table.html() + "<p><small>";
  for (const VerdictQuestion& question : verdict_questions())
    html += fmt::format("<strong>{}</strong>: {}. ", html_text(question.name), html_text(question.meaning));
  return html + "</small></p>\n";
}

/// The experiments one by one, and how many there are.
std::string experiment_table(const ChangeInput& input) {
  HtmlTable table("Experiments with an answer that became right, or is right no more.",
                  {{"No."},
                   {"Kind", HtmlTable::Align::left},
                   {"Fault, and how to replay it", HtmlTable::Align::text},
                   {"A says", HtmlTable::Align::left},
                   {"B says", HtmlTable::Align::left},
                   {"Right, then not", HtmlTable::Align::left},
                   {"Not, then right", HtmlTable::Align::left}});
  const std::map<std::int64_t, LoopPair> loops = loops_with(input, shown_experiments(input));
  std::size_t rows = 0;
  for (const MethodChange& method : input.methods) {
    const std::map<std::int64_t, Changed> experiments = changed_experiments(method);
    if (!experiments.empty() && rows < kMostChanges)
      table.group(html_text(method.name));
    for (const auto& [index, changed] : experiments) {
      if (++rows > kMostChanges)
        continue;
      const auto& [before, now] = loops.at(index);
      table.row({fmt::format("{}", index), kind_name(now.draw.kind), replay_cell(input, now.draw),
                 html_text(answer_text(input.before.study, before, before.assessments[method.before])),
                 html_text(answer_text(input.now.study, now, now.assessments[method.now])),
                 "<span class=\"no\">" + html_text(changed.lost) + "</span>",
                 "<span class=\"yes\">" + html_text(changed.gained) + "</span>"});
    }
  }
  if (rows == 0)
    return "<p class=\"absent\">No answer became right or wrong.</p>\n";
  return table.html() +
         (rows > kMostChanges ? fmt::format("<p>And {} more.</p>\n", rows - kMostChanges) : std::string());
}

}  // namespace

ReportSection change_verdicts_section(const ChangeInput& input) {
  ReportSection section{"verdicts", "Which experiments changed their verdict?", {}};
  if (!input.pairing.paired())
    section.leave_out("the runs are not paired: " + input.pairing.obstacle + ".");
  else if (names_of_methods(input.methods, [](const auto& method) { return method.changed(); }).empty())
    section.leave_out("no verdict and no number of a method that both archives have changed.");
  else {
    section.add(count_table(input));
    section.add(experiment_table(input));
  }
  return section;
}

}  // namespace mpm
