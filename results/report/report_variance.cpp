#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kOther{colour::kLightGrey, Dash::none, Mark::circle, 1.0, 0.32};
/// The pen of the affected CV. It shows why one linear S0 does not describe the loop.
Pen affected_pen(NonlinearCause cause) {
  switch (cause) {
    case NonlinearCause::unstable:
      return {colour::kVermillion, Dash::none, Mark::dot, 1.0, 0.45};
    case NonlinearCause::other_cv_active:
      return {colour::kOrange, Dash::none, Mark::dot, 1.0, 0.38};
    case NonlinearCause::mv_at_limit:
      return {colour::kGreen, Dash::none, Mark::dot, 1.0, 0.38};
    case NonlinearCause::none:
      break;
  }
  return {colour::kBlue, Dash::none, Mark::dot, 1.0, 0.38};
}
const Pen kLine{colour::kVermillion, Dash::solid, Mark::none, 2.0};
const Pen kIdentity{colour::kBlack, Dash::dashed, Mark::none, 1.0};

struct Pairs {
  std::map<NonlinearCause, std::vector<NamedPoint>> affected;
  std::vector<NamedPoint> others;
  double least = INFINITY, largest = -INFINITY;  ///< of Ivar
  double least_basis = INFINITY;                 ///< of Ivar_basis

  void add(const ReportInput& input, const ExperimentRecord& record) {
    const Study& study = input.campaign.study;
    const Eigen::MatrixXd ivar = record.chain().values("ivar");
    const NonlinearCause cause = first_cause(record.conditions);
    const std::string because = cause == NonlinearCause::none ? "" : fmt::format("; {}", title_of(cause));
    for (Eigen::Index cv = 0; cv < ivar.size(); ++cv) {
      const double x = ivar(cv);
      const double y = record.ivar_basis(cv);
      if (!(x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y)))
        continue;
      least = std::min(least, x);
      largest = std::max(largest, x);
      least_basis = std::min(least_basis, y);
      (cv == record.draw.true_cv() ? affected[cause] : others)
          .push_back(
              {x, y,
               fmt::format("experiment {} ({}), {}: Ivar {:.3g}, Ivar_basis {:.3g}{}", record.draw.index,
                           kind_name(record.draw.kind), cv_name(study, cv), x, y, because),
               experiment_anchor(input, record)});
    }
  }
  bool empty() const { return affected.empty() && others.empty(); }
};

Pairs pairs_of(const ReportInput& input, ExperimentKind kind) {
  Pairs pairs;
  records_of(input.campaign).each([&](const ExperimentRecord& record) {
    if (record.draw.kind == kind && record.status == ExperimentStatus::ok)
      pairs.add(input, record);
  });
  return pairs;
}

/// Draws the regression line over the range of the pairs, at points that are evenly spaced on a logarithmic
/// axis.
void add_fit(PanelScript& panel, const LinearFit& fit, const Pairs& pairs) {
  constexpr int kPoints = 80;
  std::vector<double> x, y;
  for (int i = 0; i <= kPoints; ++i) {
    const double at = pairs.least * std::pow(pairs.largest / pairs.least, static_cast<double>(i) / kPoints);
    const double value = fit.intercept + fit.slope * at;
    if (value < pairs.least_basis)
      continue;  // falling to zero, it would stretch the axis
    x.push_back(at);
    y.push_back(value);
  }
  panel.line(x, y, kLine);
}

Panel kind_panel(const ReportInput& input, const KindFindings& kind, const Pairs& pairs) {
  const DiagnosisOptions& options = input.campaign.study.diagnosis;
  const LinearFitIntervals& fit = kind.regression;
  const std::string title = std::isnan(fit.fit.r_squared)
                                ? kind_name(kind.kind)
                                : fmt::format("{}: R\xC2\xB2 = {:.2f}{}", kind_name(kind.kind),
                                              fit.fit.r_squared, interval_words(fit.r_squared, 2));
  PanelScript panel(fmt::format("ivar_{}", to_string(kind.kind)), title,
                    {.label = "Ivar (-)", .logarithmic = true},
                    {.label = "Ivar_{basis} (-)", .logarithmic = true});
  panel.upright_band(options.impact_lower, options.impact_upper);
  panel.points(pairs.others, kOther);
  for (const auto& [cause, points] : pairs.affected)
    panel.points(points, affected_pen(cause));
  panel.line({pairs.least, pairs.largest}, {pairs.least, pairs.largest}, kIdentity);
  add_fit(panel, fit.fit, pairs);
  return panel.finish(fmt::format("Ivar_basis against Ivar of every CV of the {} experiments, with the "
                                  "regression line.",
                                  kind_name(kind.kind)),
                      330);
}

Table regression_table(const ReportInput& input) {
  Table table("Regression of Ivar_{basis} on Ivar, all CVs; intervals by resampling whole experiments.",
              {{"Kind", Table::Align::left}, {"R\xC2\xB2"}, {"Slope"}, {"Intercept"}, {"Pairs"}});
  for (const KindFindings& kind : input.kinds()) {
    const LinearFitIntervals& fit = kind.regression;
    table.row({kind_name(kind.kind), fixed(fit.fit.r_squared, fit.r_squared), fixed(fit.fit.slope, fit.slope),
               fixed(fit.fit.intercept), fit.fit.pairs});
  }
  return table;
}

bool causes_are_known(const ReportInput& input) {
  return std::any_of(input.kinds().begin(), input.kinds().end(),
                     [](const KindFindings& kind) { return !kind.without_cause.empty(); });
}

/// Shows how much one linear S0 explains without the loops of each cause for which it cannot describe a loop.
Table cause_table(const ReportInput& input) {
  Table table(
      fmt::format("R\xC2\xB2 of Ivar_{{basis}} on Ivar, all CVs, without the experiments that one linear "
                  "S_{{0}} cannot describe: the loop is unstable with the active set of the basis case, or a "
                  "CV or MV that is free there is at a limit in more than {:g} % of the samples.",
                  100.0 * kOftenActive),
      {{"Kind", Table::Align::left},
       {"Without", Table::Align::left},
       {"Experiments left out"},
       {"R\xC2\xB2"},
       {"Slope"},
       {"Pairs"}});
  for (const KindFindings& kind : input.kinds())
    for (const KindFindings::WithoutCause& without : kind.without_cause)
      table.row(
          {kind_name(kind.kind),
           without.cause == NonlinearCause::none ? "all of these" : std::string(title_of(without.cause)),
           without.experiments, fixed(without.fit.r_squared), fixed(without.fit.slope), without.fit.pairs});
  return table;
}

}  // namespace

Section variance_section(const ReportInput& input) {
  const DiagnosisOptions& options = input.campaign.study.diagnosis;
  Section section{"variance", "Does Ivar show what the fault costs?", {}};
  Figure figure;
  figure.name = "ivar";
  figure.caption = fmt::format(
      "Ivar_{{basis}} (the true effect of the fault on the variance) against Ivar (its estimate from the "
      "loop data), one point per CV and experiment; thesis figures 6.18 and 6.22. Grey band: no impact, Ivar "
      "from {:g} "
      "to {:g}. The regression is a straight line, bent by the logarithmic axes.",
      options.impact_lower, options.impact_upper);
  figure.legend = {{"affected CV", affected_pen(NonlinearCause::none)}};
  if (causes_are_known(input))
    for (const NonlinearCause cause : kNonlinearCauses)
      if (cause != NonlinearCause::none)
        figure.legend.push_back({fmt::format("the same, {}", title_of(cause)), affected_pen(cause)});
  figure.legend.push_back({"other CVs", kOther});
  figure.legend.push_back({"regression, all CVs", kLine});
  figure.legend.push_back({"Ivar_{basis} = Ivar", kIdentity});
  for (const KindFindings& kind : input.kinds())
    if (const Pairs pairs = pairs_of(input, kind.kind); !pairs.empty())
      figure.panels.push_back(kind_panel(input, kind, pairs));
  if (figure.panels.empty()) {
    section.leave_out("no experiment has variance indices.");
    return section;
  }
  section.answer = variance_answer(input);
  section.add(std::move(figure));
  section.add(regression_table(input));
  if (causes_are_known(input))
    section.add(cause_table(input));
  return section;
}

}  // namespace mpm
