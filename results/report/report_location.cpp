#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/document/document_html.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// Returns the depth of the colour of a field that has this share of its row.
double depth_of_share(double share) {
  return 0.15 + 0.65 * share;
}

/// A cell of a heat map: blue for right verdicts, orange for wrong ones, deeper for a larger share of the
/// row.
std::string cell(std::int64_t count, std::int64_t of_row, bool right) {
  if (count == 0)
    return "<td class=\"number zero\">0</td>";
  const double of_all = static_cast<double>(count) / static_cast<double>(of_row);
  return fmt::format("<td class=\"number heat\" style=\"background:rgba({},{:.2f})\">{}</td>",
                     right ? "86,180,233" : "230,159,0", depth_of_share(of_all), count);
}

/// Formats an interval without decimals, because a row has only a few experiments.
std::string whole_percents(const Interval& interval) {
  return fmt::format("<span class=\"interval\">{:.0f} to {:.0f}&nbsp;%</span>", 100.0 * interval.lower,
                     100.0 * interval.upper);
}

std::string matrix_table(const Study& study, const KindFindings& kind) {
  const ConfusionMatrix& confusion = kind.confusion;
  std::string head;
  for (const PlantModel::Variable& cv : study.plant.cvs)
    head += fmt::format("<th scope=\"col\" class=\"number\">{}</th>", html_text(cv.name));
  std::string rows;
  for (Eigen::Index truth = 0; truth < confusion.classes(); ++truth) {
    const std::int64_t of_row = confusion.counts().row(truth).sum();
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", html_text(cv_name(study, truth)));
    for (Eigen::Index found = 0; found < confusion.classes(); ++found)
      rows += cell(confusion.counts()(truth, found), of_row, truth == found);
    const Rate recall = confusion.recall(truth, study.aggregate.confidence);
    rows += fmt::format("<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
                        number_html(share(recall.value)),
                        of_row > 0 ? whole_percents(recall.interval) : number_html({}));
  }
  const Rate all = confusion.accuracy(study.aggregate.confidence);
  rows += fmt::format(
      "<tr class=\"sum\"><th scope=\"row\">all</th><td class=\"number\" colspan=\"{}\">{} of {} located</td>"
      "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
      confusion.classes(), all.hits, all.total, number_html(share(all.value)), whole_percents(all.interval));
  return scrolling_table(
      kind_name(kind.kind),
      fmt::format("<table class=\"matrix\" aria-label=\"Confusion matrix, {}\">\n"
                  "<thead><tr><th scope=\"col\">true</th>{}<th scope=\"col\" class=\"number\">located</th>"
                  "<th scope=\"col\" class=\"number\">{}</th></tr></thead>\n<tbody>\n{}</tbody></table>",
                  kind_name(kind.kind), head,
                  fmt::format("{:g}&nbsp;% interval", 100.0 * study.aggregate.confidence), rows));
}

/// Draws the matrix as a heat map, with the true CVs from top to bottom.
Panel matrix_panel(const Study& study, const KindFindings& kind) {
  const ConfusionMatrix& confusion = kind.confusion;
  const Eigen::Index classes = confusion.classes();
  const double last = static_cast<double>(classes) - 1.0;
  Axis located{.label = "CV located", .lower = -0.5, .upper = last + 0.5};
  Axis truth{.label = "CV with the fault", .lower = -0.5, .upper = last + 0.5};
  for (Eigen::Index cv = 0; cv < classes; ++cv) {
    located.words.push_back(as_label(cv_name(study, cv)));
    truth.words.push_back(as_label(cv_name(study, classes - 1 - cv)));
  }
  const Rate all = confusion.accuracy(study.aggregate.confidence);
  PanelScript panel(fmt::format("confusion_{}", to_string(kind.kind)),
                    fmt::format("{}: {} of {} located", kind_name(kind.kind), all.hits, all.total), located,
                    truth);
  for (Eigen::Index row = 0; row < classes; ++row) {
    const auto of_row = static_cast<double>(confusion.counts().row(row).sum());
    for (Eigen::Index column = 0; column < classes; ++column)
      if (const std::int64_t count = confusion.counts()(row, column); count > 0)
        panel.field(static_cast<double>(column), last - static_cast<double>(row),
                    row == column ? colour::kSky : colour::kOrange,
                    depth_of_share(static_cast<double>(count) / of_row), fmt::format("{}", count));
  }
  return panel.finish(
      fmt::format("Confusion matrix of the {} experiments with impact.", kind_name(kind.kind)), 380);
}

}  // namespace

Section location_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  Section section{"location", "Is the right CV found?", {}};
  section.answer = location_answer(input);
  std::string tables;
  std::string without;
  Figure figure;
  figure.name = "confusion";
  figure.caption = "CV with the fault against CV located, experiments with impact.";
  for (const KindFindings& kind : input.kinds()) {
    if (kind.confusion.total() > 0) {
      tables += matrix_table(study, kind);
      figure.panels.push_back(matrix_panel(study, kind));
    } else {
      without += (without.empty() ? "" : ", ") + kind_name(kind.kind);
    }
  }
  if (!figure.panels.empty())
    section.file_figures.push_back(std::move(figure));
  if (!tables.empty())
    section.add(
        "<p>Experiments with impact: the CV with the fault (rows) against the CV whose Ivar<sub>diag</sub> "
        "is farthest from 1 (columns); thesis figures 6.20 and 6.23. Blue is right, orange is wrong; the "
        "deeper the colour, the larger the share of the row.</p>\n<div class=\"matrices\">\n" +
        tables + "</div>\n");
  if (tables.empty() || !without.empty())
    section.leave_out(fmt::format("no experiment{}{} has an impact, so there is no CV to locate.",
                                  without.empty() ? "" : " of kind ", without));
  return section;
}

}  // namespace mpm
