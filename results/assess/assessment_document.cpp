#include "results/assess/assessment_document.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/settling_time.hpp"
#include "results/assess/assessment_sentences.hpp"
#include "results/assess/repair_form.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

Cell word(double flag) {
  return std::isnan(flag) ? Cell("-") : flag == 1.0 ? Cell("yes").toned(Cell::Tone::strong) : Cell("no");
}

/// The warnings: the page shows their count and hides them until a reader opens the list.
Section warnings_section(const RecordAssessment& of) {
  Section section{"warnings", "Look at these"};
  if (of.warnings.empty())
    return section;
  Sentences words;
  for (const std::string& warning : of.warnings)
    words.words.push_back(as_label(warning));
  section.add(fmt::format("<details class=\"fold\"><summary>{}</summary>\n",
                          counted(std::ssize(of.warnings), "warning")));
  section.add(std::move(words));
  section.add("</details>\n");
  return section;
}

/// Converts values to the unit of the column and adds the operating point, as the file has them.
std::vector<double> as_recorded(const RecordAssessment& of, const std::string& name,
                                const Eigen::RowVectorXd& values) {
  const auto look = [&name](const DataOptions::Numbers& numbers, double fallback) {
    const auto found = numbers.find(name);
    return found == numbers.end() ? fallback : found->second;
  };
  const Eigen::RowVectorXd columns =
      values.array() / look(of.data.scale, 1.0) + look(of.data.operating_point, 0.0);
  return {columns.begin(), columns.end()};
}

/// Returns a time axis with a stamp at each whole number. If all stamps end with ":00", that is left out.
Axis stamps_axis(const std::vector<std::string>& stamps, int steps) {
  constexpr double kRoom = 1.15;  // space for the text of the last stamp
  Axis axis{.label = "", .lower = 0.0, .upper = kRoom * static_cast<double>(steps)};
  const bool to_the_minute = std::all_of(stamps.begin(), stamps.end(), [](const std::string& stamp) {
    return stamp.size() == 19 && stamp.ends_with(":00");
  });
  for (int i = 0; i <= steps; ++i) {
    const std::string& stamp =
        stamps[(stamps.size() - 1) * static_cast<std::size_t>(i) / static_cast<std::size_t>(steps)];
    axis.words.push_back(as_label(to_the_minute ? stamp.substr(0, 16) : stamp));
  }
  return axis;
}

/// What an engineer looks at first: the worst CV as measured, and as the model simulates it from the MVs.
Figure worst_figure(const RecordAssessment& of) {
  constexpr int kSteps = 2;
  constexpr double kHeight = 260;
  const Pen measured{colour::kBlack, Dash::solid, Mark::none, 1.0};
  const Pen model{colour::kVermillion, Dash::solid, Mark::none, 2.0};
  const Eigen::Index cv = worst_cv(of);
  const PlantModel::Variable& variable = of.study.plant.cvs[static_cast<std::size_t>(cv)];
  const auto tag = of.data.tags.find(variable.name);
  const std::string name =
      as_label(variable.name) + (tag == of.data.tags.end() ? "" : ", " + as_label(tag->second));
  const std::string unit =
      variable.unit == "1" || of.data.scale.contains(variable.name) ? "" : as_label(variable.unit);
  std::vector<double> time;
  const auto last = static_cast<double>(std::max<Eigen::Index>(1, of.record.samples() - 1));
  for (Eigen::Index k = 0; k < of.record.samples(); ++k)
    time.push_back(kSteps * static_cast<double>(k) / last);
  PanelScript panel("worst", name, stamps_axis(of.record.stamps, kSteps), {.label = unit});
  if (of.verdict.model.since)
    panel.upright_band(kSteps * static_cast<double>(of.verdict.model.since->sample) / last, kSteps);
  panel.line(time, as_recorded(of, variable.name, of.record.y.row(cv)), measured);
  Eigen::RowVectorXd y_sim = of.loop.y_sim.row(cv);
  y_sim.head(of.unjudged).setConstant(kNaN);  // not judged: the MVs before the record are not known
  panel.line(time, as_recorded(of, variable.name, y_sim), model);
  Figure figure;
  figure.name = "measured-and-model";
  figure.caption =
      fmt::format("{}: measured, and simulated by the model from the recorded MVs and disturbances{}{}",
                  as_label(variable.name), of.model_error > 0.0 ? ", except for a constant" : "",
                  of.verdict.model.since ? "; shaded from where something is wrong" : "");
  figure.legend = {{"measured", measured}, {"model", model}};
  figure.panels.push_back(
      panel.finish(fmt::format("{} as measured and as simulated by the model, over time.", variable.name),
                   kHeight, 2 * kPanelWidth));
  figure.columns = 1;
  return figure;
}

/// Describes the state of a channel; a wrong one as "wrong, gain x 1.6" or "wrong, dead time +2 min".
Cell period_cell(const RecordAssessment& of, const ChannelPeriod& period) {
  if (period.state == ChannelState::good)
    return Cell("good").toned(Cell::Tone::good);
  if (period.state == ChannelState::in_doubt)
    return {"in doubt"};
  const std::string size =
      period.parameter == MismatchParameter::dead_time
          ? fmt::format("dead time {:+.2g} {}", period.size, as_label(of.study.plant.time_unit))
          : fmt::format("{} x {:.2g}", period.parameter == MismatchParameter::gain ? "gain" : "time constant",
                        period.size);
  return Cell("wrong, " + size).toned(Cell::Tone::bad);
}

Section verdict_section(const RecordAssessment& of, const AssessmentText& text) {
  Section section{"verdict", "The verdict"};
  Facts box;
  box.add("Model", as_label(text.verdict.model));
  box.add("Loop", as_label(text.verdict.loop));
  box.add("Action", as_label(text.verdict.action));
  box.add("Benchmark", as_label(text.verdict.benchmark));
  section.add(std::move(box));
  section.add(worst_figure(of));
  return section;
}

/// Scores, thresholds and probabilities behind the verdict.
Section why_section(const AssessmentText& text) {
  Section section{"why", "Why"};
  const auto say_all = [&section](const std::string& heading, const std::vector<std::string>& lines) {
    if (lines.empty())
      return;
    section.say(strong(heading));
    Sentences words;
    for (const std::string& line : lines)
      words.words.push_back(as_label(line));
    section.add(std::move(words));
  };
  say_all("Errors of the model", text.verdict.scores);
  say_all("Cost of each CV over that of the loop as designed", text.verdict.costs);
  if (!text.verdict.probabilities.empty())
    section.say(as_label(text.verdict.probabilities));
  std::vector<std::string> trust = text.trust;
  trust.insert(trust.end(), text.further.begin(), text.further.end());
  say_all("How far to trust it", trust);
  return section;
}

/// Table with one row per channel and one column per period.
Section health_section(const RecordAssessment& of) {
  Section section{"health", "The channels over time"};
  if (of.health.empty())
    return section;
  Table table(
      fmt::format("Each channel in periods of the record of its own: good, wrong with its size (score above "
                  "{:.3g}), or in doubt, where an error of half its gain would not show",
                  of.health_threshold()),
      {{"channel", Table::Align::left}});
  for (const Eigen::Index begin : of.periods)
    table.columns.push_back(
        {as_label("from " + of.record.stamps[static_cast<std::size_t>(begin)]), Table::Align::left});
  for (const ChannelHistory& history : of.health) {
    const Eigen::Index nu = of.study.mv_count();
    const std::string input = history.input < nu
                                  ? mv_name(of.study, history.input)
                                  : of.study.plant.mds[static_cast<std::size_t>(history.input - nu)].name;
    std::vector<Cell> cells{as_label(fmt::format("{}/{}", cv_name(of.study, history.cv), input))};
    for (const ChannelPeriod& period : history.periods)
      cells.push_back(period_cell(of, period));
    table.row(std::move(cells));
  }
  section.add(std::move(table));
  return section;
}

/// Step responses of the channel that is repaired: in the model, and corrected.
Figure step_figure(const RecordAssessment& of) {
  constexpr double kHeight = 220;
  constexpr double kSettled = 1.5;  // times the longer settling time
  const Pen old{colour::kVermillion, Dash::dashed, Mark::none, 1.5};
  const Pen corrected{colour::kBlack, Dash::solid, Mark::none, 2.0};
  const ChannelRepair& repair = of.repair->repair;
  const TransferFunction& model = of.study.plant.G(repair.channel.cv, repair.channel.mv);
  const double Ts = of.study.controller.sample_time;
  const double settled = std::max(settling_time(model), settling_time(repair.model));
  const auto samples =
      static_cast<Eigen::Index>(std::clamp(std::ceil(kSettled * settled / Ts), 10.0, 2000.0));
  const std::string channel = channel_name(of.study, repair.channel);
  PanelScript panel("step", as_label(channel), {.label = as_label(of.study.plant.time_unit)}, {.label = ""});
  const auto draw = [&](const TransferFunction& of_channel, const Pen& pen) {
    const Eigen::RowVectorXd y = step_response(TransferMatrix{{of_channel}}, Ts, samples).front().row(0);
    std::vector<double> time;
    for (Eigen::Index k = 0; k < y.size(); ++k)
      time.push_back(Ts * static_cast<double>(k + 1));
    panel.line(time, {y.begin(), y.end()}, pen);
  };
  draw(model, old);
  draw(repair.model, corrected);
  Figure figure;
  figure.name = "step-response";
  figure.caption = fmt::format("Step response of {}: in the model, and corrected", as_label(channel));
  figure.legend = {{"model", old}, {"corrected", corrected}};
  figure.panels.push_back(
      panel.finish(fmt::format("Step response of {} in the model and corrected.", channel), kHeight));
  figure.columns = 1;
  return figure;
}

/// The score of each window, drawn at its last sample.
Figure trend_figure(const RecordAssessment& of, const Eigen::RowVectorXd& scores) {
  constexpr double kHeight = 220;
  const Pen score{colour::kBlue, Dash::solid, Mark::dot, 1.5};
  const Pen limit{colour::kVermillion, Dash::dashed, Mark::none, 1.5};
  const MonitoringOptions& monitoring = *of.study.monitoring;
  constexpr int kSteps = 2;
  const auto last = static_cast<double>(std::max<Eigen::Index>(1, of.record.samples() - 1));
  std::vector<double> time, values;
  for (int window = 0; window < scores.size(); ++window) {
    time.push_back(kSteps * static_cast<double>(monitoring.end(window) - 1) / last);
    values.push_back(scores(window));
  }
  PanelScript panel("trend", "score", stamps_axis(of.record.stamps, kSteps), {.label = ""});
  panel.line(time, values, score);
  Figure figure;
  figure.name = "score-of-windows";
  figure.caption = "Score of each window, at its last sample";
  figure.legend = {{"score", score}};
  if (const TrialFindings* const trial = of.trial_of(0); trial && std::isfinite(trial->threshold)) {
    panel.across(trial->threshold, limit);
    figure.legend.push_back({"threshold of a whole record", limit});
  }
  figure.panels.push_back(panel.finish("Score of the method over time, window by window.", kHeight));
  figure.columns = 1;
  return figure;
}

Section repair_section(const RecordAssessment& of, const AssessmentText& text) {
  Section section{"repair", "What a repair would bring"};
  Sentences words;
  for (const std::string& sentence : text.repair)
    words.words.push_back(as_label(sentence));
  if (!words.words.empty())
    section.add(std::move(words));
  if (!of.prospects.empty())
    section.add(prospects_table(of.study, of.prospects));
  if (of.repair)
    section.add(step_figure(of));
  return section;
}

Section windows_section(const RecordAssessment& of) {
  Section section{"windows", "Over time"};
  const Eigen::MatrixXd flags = of.said.front().values("window_flagged");
  const Eigen::MatrixXd scores = of.said.front().values("window_score");
  Table table("Verdicts of the same method on a window that moves over the record",
              {{"window", Table::Align::left}, {"flagged"}, {"score"}});
  for (int window = 0; window < flags.cols(); ++window)
    table.row({as_label(window_text(of, window)), word(flags(0, window)), Number{scores(0, window)}});
  if (table.rows.empty())
    return section;
  section.add(trend_figure(of, scores.row(0)));
  section.add(std::move(table));
  return section;
}

/// What each method says and, if there are simulated loops, how often it is right on them.
Section trust_section(const RecordAssessment& of) {
  Section section{"methods", "The methods"};
  Table table(of.trial ? fmt::format("Verdict of each method on this record, and its results on {} simulated "
                                     "loops of this controller, excitation and length, in %",
                                     of.trial->loops)
                       : "Verdict of each method on this record",
              {{"method", Table::Align::left}, {"flagged"}, {"score"}, {"CV"}, {"source"}});
  constexpr std::string_view kRates[] = {"false_alarm_healthy", "detected", "located", "source"};
  if (of.trial)
    table.columns.push_back({"threshold"});
  for (const std::string_view rate : kRates)
    if (of.trial)
      table.columns.push_back({heading_of(rate)});
  Sentences reasons;
  for (std::size_t m = 0; m < of.said.size(); ++m) {
    const AssessmentRecord& said = of.said[m];
    const std::string name = as_label(said.form->method().name);
    const bool flagged = of.is_flagged(m);
    std::vector<Cell> cells{
        name, said.answered() ? word(flagged ? 1.0 : 0.0) : Cell(std::string(to_string(said.status))),
        Number{said.score}, flagged ? as_label(cv_name(of.study, said.predicted_cv)) : "-",
        flagged ? as_label(source_words(of.study, said, named_source(said))) : "-"};
    const TrialFindings* const found = of.trial_of(m);
    if (of.trial)
      cells.emplace_back(found ? Cell(Number{found->threshold}) : Cell("-"));
    for (const std::string_view rate : kRates)
      if (of.trial)
        cells.emplace_back(found ? Cell(number(found->rates[rate], NumberForm::percent)) : Cell("-"));
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
  const AssessmentText text = assessment_text(of);
  for (Section section :
       {verdict_section(of, text), warnings_section(of), why_section(text), health_section(of),
        repair_section(of, text), windows_section(of), trust_section(of), record_section(of)})
    if (!section.content.empty())
      document.sections.push_back(std::move(section));
  return document;
}

}  // namespace mpm
