#include <algorithm>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// What was found; the wrong one is marked.
std::string marked(const std::string& found, Correctness correctness) {
  return correctness == Correctness::right || correctness == Correctness::not_judged
             ? found
             : "<span class=\"no\">" + found + "</span>";
}

std::string of_cv(const Eigen::VectorXd& values, Eigen::Index cv) {
  return html_number(cv >= 0 && cv < values.size() ? values(cv) : NAN);
}

/// What was wrong, and below it the command that runs the experiment again.
std::string fault_cell(const ReportInput& input, const ExperimentRecord& record) {
  return fmt::format("{}<br><code>mpmbench replay {} {}</code>",
                     html_text(fault_text(input.campaign.study, record.draw)), html_text(input.file),
                     record.draw.index);
}

std::string wrong_table(const ReportInput& input) {
  const Study& study = input.campaign.study;
  HtmlTable table(
      "Experiments with impact whose CV, or the source of a single fault, is not the true one (marked). Ivar "
      "and Ivar<sub>diag</sub> are those of the true CV, then Ivar<sub>diag</sub> of the located one.",
      {{"No."},
       {"Kind", HtmlTable::Align::left},
       {"Fault, and how to replay it", HtmlTable::Align::text},
       {"True CV", HtmlTable::Align::left},
       {"Located", HtmlTable::Align::left},
       {"Source", HtmlTable::Align::left},
       {"I<sub>MPM</sub>"},
       {"Ivar"},
       {"Ivar<sub>diag</sub>"},
       {"of located"},
       {"Dominance"}});
  const std::vector<const ExperimentRecord*>& wrong = input.parts.wrong;
  for (std::size_t i = 0; i < std::min(wrong.size(), kMostVerdictRows); ++i) {
    const ExperimentRecord& record = *wrong[i];
    const Diagnosis verdict = record.chain();
    const Judgement judgement = judge(study, record, *record.by(kChainMethod));
    const bool faultless = is_faultless(record.draw.kind);
    const std::string number = fmt::format("{}", record.draw.index);
    table.row(
        {input.shows_loop(record.draw.index) ? fmt::format("<a href=\"#loop-{0}\">{0}</a>", number) : number,
         kind_name(record.draw.kind), fault_cell(input, record),
         html_text(cv_name(study, record.draw.true_cv())),
         marked(html_text(cv_name(study, verdict.predicted_cv)),
                faultless ? Correctness::wrong : judgement.predicted_cv),
         marked(source_name(verdict.predicted_source),
                faultless ? Correctness::wrong : judgement.predicted_source),
         html_number(verdict.indicator.i_mpm), of_cv(verdict.ivar, record.draw.true_cv()),
         of_cv(verdict.ivar_diag, record.draw.true_cv()), of_cv(verdict.ivar_diag, verdict.predicted_cv),
         html_number(verdict.alone.dominance_mpm)});
  }
  std::string html = table.html();
  if (input.parts.wrong_verdicts.size() > kMostVerdictRows)
    html += fmt::format("<p>And {} more; <code>mpmbench summary {} --json</code> lists all.</p>\n",
                        input.parts.wrong_verdicts.size() - kMostVerdictRows, html_text(input.file));
  return html;
}

std::string failed_table(const ReportInput& input) {
  HtmlTable table("Experiments that failed.", {{"No."},
                                               {"Kind", HtmlTable::Align::left},
                                               {"Fault, and how to replay it", HtmlTable::Align::text},
                                               {"Why", HtmlTable::Align::text}});
  const std::vector<const ExperimentRecord*>& failed = input.parts.failed;
  for (std::size_t i = 0; i < std::min(failed.size(), kMostVerdictRows); ++i)
    table.row({fmt::format("{}", failed[i]->draw.index), kind_name(failed[i]->draw.kind),
               fault_cell(input, *failed[i]), html_text(failed[i]->message)});
  return table.html();
}

}  // namespace

ReportSection wrong_verdict_section(const ReportInput& input) {
  ReportSection section{"wrong-verdicts", "Wrong verdicts", {}};
  if (!input.parts.failed.empty())
    section.add(failed_table(input));
  if (input.parts.wrong.empty()) {
    section.leave_out("no experiment with impact got a wrong verdict.");
    return section;
  }
  std::int64_t impactful = 0;
  for (const KindFindings& kind : input.kinds())
    impactful += kind.flagged.hits;
  for (const FalseAlarms& group : input.false_alarms())
    impactful += group.parameter ? 0 : group.false_alarm.hits;
  section.add(
      fmt::format("<p>{} of {} experiments with impact got a wrong verdict. <code>mpmbench plot {} INDEX -o "
                  "FILE.svg</code> draws the closed loop of one.</p>\n",
                  input.parts.wrong_verdicts.size(), impactful, html_text(input.file)));
  section.add(wrong_table(input));
  add_wrong_loops(section, input);
  return section;
}

}  // namespace mpm
