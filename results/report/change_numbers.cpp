#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/change_sections.hpp"
#include "results/report/html_table.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kUnchangedVerdict{colour::kBlue, Dash::none, Mark::dot, 1.0, 0.35};
const Pen kChangedVerdict{colour::kVermillion, Dash::none, Mark::triangle, 1.0, 0.6};
const Pen kSameNumber{colour::kBlack, Dash::dashed, Mark::none, 1.0};

/// A number of the chain that has a panel.
struct PanelNumber {
  const char *name, *label;
  bool logarithmic;
};
constexpr PanelNumber kPanelNumbers[] = {
    {"ivar", "Ivar", true}, {"ivar_diag", "Ivar_{diag}", true}, {"i_mpm", "I_{MPM}", false}};

std::set<std::int64_t> experiments_with_changes(const MethodChange& method) {
  std::set<std::int64_t> indices;
  for (const VerdictChange& verdict : method.verdicts)
    for (const auto* list : {&verdict.changes.lost, &verdict.changes.gained})
      for (const JudgementPair& pair : *list)
        indices.insert(pair.index);
  return indices;
}

/// One value of A against B, one point a CV and experiment; without points when neither has it.
std::optional<Panel> number_panel(const ChangeInput& input, const MethodChange& method,
                                  const PanelNumber& number) {
  const std::set<std::int64_t> changed = experiments_with_changes(method);
  std::vector<NamedPoint> same, other;
  double least = INFINITY, largest = -INFINITY;
  const auto add = [&](const ExperimentRecord& record_before, const ExperimentRecord& record_now) {
    const std::int64_t index = record_now.draw.index;
    const Eigen::MatrixXd before = record_before.assessments[method.before].values(number.name);
    const Eigen::MatrixXd now = record_now.assessments[method.now].values(number.name);
    for (Eigen::Index i = 0; i < std::min(before.size(), now.size()); ++i) {
      const double x = before.data()[i], y = now.data()[i];
      if (!std::isfinite(x) || !std::isfinite(y) || (number.logarithmic && !(x > 0.0 && y > 0.0)))
        continue;
      least = std::min({least, x, y});
      largest = std::max({largest, x, y});
      const std::string cv = now.size() > 1 ? ", " + cv_name(input.now.study, i) : std::string();
      (changed.count(index) > 0 ? other : same)
          .push_back({x, y,
                      fmt::format("experiment {} ({}){}: A {:.3g}, B {:.3g}", index,
                                  kind_name(record_now.draw.kind), cv, x, y)});
    }
  };
  each_in_both(records_of(input.before), records_of(input.now), add);
  if (same.empty() && other.empty())
    return std::nullopt;
  PanelScript panel(fmt::format("change_{}", number.name), number.label,
                    {.label = fmt::format("{} in A (-)", number.label), .logarithmic = number.logarithmic},
                    {.label = fmt::format("{} in B (-)", number.label), .logarithmic = number.logarithmic});
  panel.line({least, largest}, {least, largest}, kSameNumber);
  panel.points(same, kUnchangedVerdict);
  panel.points(other, kChangedVerdict);
  return panel.finish(fmt::format("{} in B against {} in A, over the experiments in common.",
                                  plain_label(number.label), plain_label(number.label)),
                      330);
}

void add_figure(ReportSection& section, const ChangeInput& input) {
  Figure figure;
  figure.name = "change-numbers";
  figure.caption =
      "What the chain of the thesis computes, B against A, one point an experiment, of indices one a CV and "
      "experiment. On the dashed line nothing changed.";
  figure.legend = {{"verdict as right as before", kUnchangedVerdict},
                   {"an answer became right or wrong", kChangedVerdict},
                   {"A = B", kSameNumber}};
  for (const MethodChange& method : input.methods)
    if (method.name == kChainMethod)
      for (const PanelNumber& number : kPanelNumbers)
        if (std::optional<Panel> panel = number_panel(input, method, number))
          figure.panels.push_back(std::move(*panel));
  if (!figure.panels.empty())
    section.add(std::move(figure));
}

bool number_changed(const NumberChange& change) {
  return change.same < change.experiments;
}

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : html_number(value);
}

}  // namespace

ReportSection change_numbers_section(const ChangeInput& input) {
  ReportSection section{"numbers", "Ivar, I_{MPM} and scores, A against B", {}};
  if (!input.pairing.paired()) {
    section.leave_out("the runs are not paired: " + input.pairing.obstacle + ".");
    return section;
  }
  add_figure(section, input);
  HtmlTable table(
      "Numbers of the methods that changed, over the experiments in which both give a verdict; of a number "
      "of CVs the mean over these. Interval of the mean: Student&rsquo;s t.",
      {{"Number", HtmlTable::Align::left},
       {"Experiments"},
       {"Unchanged"},
       {"Mean of B &minus; A"},
       {interval_title(input.now.study)},
       {"Largest change"},
       {"in experiment"}});
  bool any = false;
  for (const MethodChange& method : input.methods) {
    if (std::none_of(method.numbers.begin(), method.numbers.end(), number_changed))
      continue;
    any = true;
    table.group(html_text(method.name));
    for (const NumberChange& change : method.numbers)
      if (number_changed(change))
        table.row({html_label(change.label), fmt::format("{}", change.experiments),
                   fmt::format("{}", change.same), short_number(change.difference.mean),
                   std::isnan(change.difference.mean_interval.lower)
                       ? html_number(kNaN)
                       : fmt::format("{:.3g} to {:.3g}", change.difference.mean_interval.lower,
                                     change.difference.mean_interval.upper),
                   short_number(change.largest),
                   change.index < 0 ? html_number(kNaN) : fmt::format("{}", change.index)});
  }
  if (any)
    section.add(table.html());
  else
    section.add(
        "<p class=\"absent\">No number of a method that both archives have changed in any experiment.</p>\n");
  return section;
}

}  // namespace mpm
