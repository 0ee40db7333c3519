#include <cmath>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/report/figure_html.hpp"
#include "results/report/html_page.hpp"
#include "results/report/html_table.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::string list_html(const std::vector<std::string>& items) {
  std::string html = "<ul>\n";
  for (const std::string& item : items)
    html += fmt::format("<li>{}</li>\n", html_text(item));
  return html + "</ul>\n";
}

std::string section(const char* id, const char* title, const std::string& content) {
  return content.empty()
             ? ""
             : fmt::format(
                   "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n"
                   "{2}</section>\n",
                   id, title, content);
}

std::string word(double flag) {
  return std::isnan(flag) ? "&ndash;" : flag == 1.0 ? "<strong>yes</strong>" : "no";
}

std::string cvs_html(const RecordAssessment& of) {
  HtmlTable table(
      "Variance of each CV over that of the nominal loop (1: as designed), and where the method sees the "
      "fault",
      {{"CV", HtmlTable::Align::left},
       {"variance against the nominal loop"},
       {"flagged"},
       {"source"},
       {"score"}});
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
    table.row({html_text(cv_name(of.study, cv)), html_number(number_of_cv(of.verdict(), "ivar", cv)),
               word(number_of_cv(of.verdict(), "cv_flagged", cv)),
               source_of_cv(of.verdict(), cv) == FaultSource::none
                   ? "&ndash;"
                   : html_text(source_name(source_of_cv(of.verdict(), cv))),
               html_number(number_of_cv(of.verdict(), "cv_score", cv))});
  return table.html();
}

std::string repair_html(const RecordAssessment& of) {
  if (!of.repair || of.repair->now.size() == 0 || of.repair->predicted.size() == 0)
    return "";
  HtmlTable table("Variances of the CVs: with the model as it is, and with the channel identified again",
                  {{"CV", HtmlTable::Align::left}, {"now"}, {"after the repair"}, {"change, %"}});
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv) {
    const double now = of.repair->now(cv), then = of.repair->predicted(cv);
    table.row({html_text(cv_name(of.study, cv)), fmt::format("{:.3g}", now), fmt::format("{:.3g}", then),
               fmt::format("{:+.0f}", 100.0 * (then / now - 1.0))});
  }
  return table.html();
}

std::string windows_html(const RecordAssessment& of) {
  const Eigen::MatrixXd flags = of.verdict().values("window_flagged");
  const Eigen::MatrixXd scores = of.verdict().values("window_score");
  if (flags.size() == 0)
    return "";
  HtmlTable table("The same method on a window that moves over the record",
                  {{"window", HtmlTable::Align::left}, {"flagged"}, {"score"}});
  for (int window = 0; window < flags.cols(); ++window)
    table.row({html_text(window_text(of, window)), word(flags(0, window)), html_number(scores(0, window))});
  return table.html();
}

std::string rate_html(const Rate& rate) {
  return rate.total == 0 ? "&ndash;"
                         : fmt::format("{} <small>({})</small>", html_number(rate.value, true),
                                       html_interval(rate.interval, true));
}

std::string trust_html(const RecordAssessment& of) {
  if (!of.trial)
    return fmt::format("<p>{}</p>\n", html_text(of.no_trial));
  HtmlTable table(
      fmt::format("What each method says of this record, and what it made of {} simulated loops of "
                  "this controller, excitation and length",
                  of.trial->loops),
      {{"method", HtmlTable::Align::left},
       {"flagged"},
       {"CV"},
       {"source"},
       {"false alarms"},
       {"power"},

       {"right CV"},
       {"right source"}});
  for (std::size_t m = 0; m < of.said.size(); ++m) {
    const AssessmentRecord& said = of.said[m];
    const MethodRates& rates = of.trial->methods[m].rates;
    const bool flagged = said.answered() && said.flagged;
    table.row({html_text(said.form->method().name),
               said.answered() ? word(said.flagged ? 1.0 : 0.0) : html_text(to_string(said.status)),
               flagged ? html_text(cv_name(of.study, said.predicted_cv)) : "&ndash;",
               flagged ? html_text(source_name(named_source(said))) : "&ndash;",
               rate_html(rates.false_alarm_healthy), rate_html(rates.detected), rate_html(rates.located),
               rate_html(rates.source)});
  }
  return table.html() +
         fmt::format(
             "<p>The loops are kept in <code>{}</code>; <code>mpmbench report</code> shows them.</p>\n",
             html_text(of.trial->archive));
}

Figure record_figure(const RecordAssessment& of) {
  Trajectory loop;
  loop.samples_done = of.loop.samples();
  loop.y = of.loop.y;
  loop.u = of.loop.u;
  loop.u_target = of.loop.u_target;
  loop.d = of.loop.d;
  loop.y_set = of.loop.y_set;
  Figure figure = trajectory_figure(of.study, loop, {of.loop.y_sim, of.y0, of.y0}, "record");
  figure.caption =
      "The record, and the nominal loop: the controller on its own model under the same disturbances";
  return figure;
}

}  // namespace

std::string assessment_html(const RecordAssessment& assessment) {
  const std::string body = section("warnings", "Look at these first",
                                   assessment.warnings.empty() ? "" : list_html(assessment.warnings)) +
                           section("verdict", "The verdict", list_html(verdict_sentences(assessment))) +
                           section("cvs", "What it costs", cvs_html(assessment)) +
                           section("repair", "What a repair would bring", repair_html(assessment)) +
                           section("windows", "Over time", windows_html(assessment)) +
                           section("trust", "How far to trust it", trust_html(assessment)) +
                           section("record", "The record", figure_html(record_figure(assessment)));
  const std::string file = html_text(assessment.file);
  return html_page(
      {assessment.file, fmt::format("{}: {}", html_text(assessment.study.plant.title), file),
       fmt::format("<p>{} samples of {:g} {}, {} to {}, against the study <strong>{}</strong>.</p>\n",
                   assessment.record.samples(), assessment.study.controller.sample_time,
                   html_text(assessment.study.plant.time_unit), html_text(assessment.record.stamps.front()),
                   html_text(assessment.record.stamps.back()), html_text(assessment.study.name)),
       fmt::format("Made by <code>mpmbench assess</code> from {}. Intervals have a confidence level "
                   "of {:g}&nbsp;%.",
                   file, 100.0 * assessment.study.aggregate.confidence),
       assessment.version},
      body);
}

}  // namespace mpm
