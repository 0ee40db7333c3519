#include <cmath>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

Cell word(double flag) {
  return std::isnan(flag) ? Cell("-") : flag == 1.0 ? Cell("yes").toned(Cell::Tone::strong) : Cell("no");
}

std::string source_words(FaultSource source) {
  return source == FaultSource::none ? "-" : source_name(source);
}

Section words_section(const char* id, const char* title, const std::vector<std::string>& sentences) {
  Section section{id, title};
  Sentences words;
  for (const std::string& sentence : sentences)
    words.words.push_back(as_label(sentence));
  if (!sentences.empty())
    section.add(std::move(words));
  return section;
}

Section cvs_section(const RecordAssessment& of) {
  Section section{"cvs", "What it costs"};
  Table table(
      "Variance of each CV over that of the nominal loop (1: as designed), and where the method sees the "
      "fault",
      {{"CV", Table::Align::left}, {"variance"}, {"flagged"}, {"source"}, {"score"}});
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
    table.row(
        {as_label(cv_name(of.study, cv)), Number{number_of_cv(of.verdict(), "ivar", cv), NumberForm::fixed},
         word(number_of_cv(of.verdict(), "cv_flagged", cv)), source_words(source_of_cv(of.verdict(), cv)),
         Number{number_of_cv(of.verdict(), "cv_score", cv), NumberForm::fixed}});
  section.add(std::move(table));
  return section;
}

Section repair_section(const RecordAssessment& of) {
  Section section{"repair", "What a repair would bring"};
  if (!of.repair || of.repair->now.size() == 0 || of.repair->predicted.size() == 0)
    return section;
  Table table("Variances of the CVs: with the model as it is, and with the channel identified again",
              {{"CV", Table::Align::left}, {"now"}, {"after the repair"}, {"change, %"}});
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv) {
    const double now = of.repair->now(cv), then = of.repair->predicted(cv);
    table.row({as_label(cv_name(of.study, cv)), Number{now}, Number{then},
               fmt::format("{:+.0f}", 100.0 * (then / now - 1.0))});
  }
  section.add(std::move(table));
  return section;
}

Section windows_section(const RecordAssessment& of) {
  Section section{"windows", "Over time"};
  const Eigen::MatrixXd flags = of.verdict().values("window_flagged");
  const Eigen::MatrixXd scores = of.verdict().values("window_score");
  Table table("The same method on a window that moves over the record",
              {{"window", Table::Align::left}, {"flagged"}, {"score"}});
  for (int window = 0; window < flags.cols(); ++window)
    table.row({as_label(window_text(of, window)), word(flags(0, window)), Number{scores(0, window)}});
  if (!table.rows.empty())
    section.add(std::move(table));
  return section;
}

/// What each method says, and how often it is right on simulated loops where there are some.
Section trust_section(const RecordAssessment& of) {
  Section section{"trust", "How far to trust it"};
  Table table(
      of.trial ? fmt::format(
                     "What each method says of this record, and what it made of {} simulated loops of this "
                     "controller, excitation and length, in %",
                     of.trial->loops)
               : "What each method says of this record",
      {{"method", Table::Align::left}, {"flagged"}, {"score"}, {"CV"}, {"source"}});
  if (of.trial)
    for (const char* const title : {"false alarms", "power", "right CV", "right source"})
      table.columns.push_back({title});
  Sentences reasons;
  for (std::size_t m = 0; m < of.said.size(); ++m) {
    const AssessmentRecord& said = of.said[m];
    const std::string name = as_label(said.form->method().name);
    const bool flagged = said.answered() && said.flagged;
    std::vector<Cell> cells{
        name, said.answered() ? word(said.flagged ? 1.0 : 0.0) : Cell(std::string(to_string(said.status))),
        Number{said.score}, flagged ? as_label(cv_name(of.study, said.predicted_cv)) : "-",
        flagged ? source_words(named_source(said)) : "-"};
    if (of.trial)
      for (const Rate MethodRates::*const rate : {&MethodRates::false_alarm_healthy, &MethodRates::detected,
                                                  &MethodRates::located, &MethodRates::source})
        cells.emplace_back(number(of.trial->methods[m].rates.*rate, NumberForm::percent));
    table.row(std::move(cells));
    if (!said.answered())
      reasons.words.push_back(name + ": " + as_label(said.reason));
  }
  section.add(std::move(table));
  if (!reasons.words.empty())
    section.add(std::move(reasons));
  section.say(of.trial ? fmt::format("The loops are kept in {}; {} shows them.", code(of.trial->archive),
                                     code("mpmbench report"))
                       : as_label(of.no_trial));
  return section;
}

Section record_section(const RecordAssessment& of) {
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
  Section section{.id = "record", .title = "The record", .shown = Shown::page};
  section.add(std::move(figure));
  return section;
}

}  // namespace

Document assessment_document(const RecordAssessment& of) {
  const std::string file = as_label(of.file);
  Document document{
      .title = of.file,
      .heading = as_label(of.study.plant.title) + ": " + file,
      .lead = fmt::format("{} samples of {:g} {}, {} to {}, against the study {}.", of.record.samples(),
                          of.study.controller.sample_time, as_label(of.study.plant.time_unit),
                          as_label(of.record.stamps.front()), as_label(of.record.stamps.back()),
                          strong(as_label(of.study.name))),
      .footer = fmt::format("Made by {} from {}. Intervals have a confidence level of {:g} %.",
                            code("mpmbench assess"), file, 100.0 * of.study.aggregate.confidence),
      .version = of.version};
  for (Section section : {words_section("warnings", "Look at these first", of.warnings),
                          words_section("verdict", "The verdict", verdict_sentences(of)), cvs_section(of),
                          repair_section(of), windows_section(of), trust_section(of), record_section(of)})
    if (!section.content.empty())
      document.sections.push_back(std::move(section));
  return document;
}

}  // namespace mpm
