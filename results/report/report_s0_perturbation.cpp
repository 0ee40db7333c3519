#include <algorithm>

#include <fmt/format.h>

#include "results/archive/variable_text.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kMedian{colour::kBlue, Dash::solid, Mark::none, 2.5};
const Pen kQuartiles{colour::kSky, Dash::solid, Mark::none, 1.5};
const Pen kExtremes{colour::kGrey, Dash::dashed, Mark::none, 1.2};
const Pen kImpactBand{colour::kVermillion, Dash::dotted, Mark::none, 1.2};
const Pen kAvailable{colour::kBlue, Dash::solid, Mark::none, 2.5};
const Pen kFixed{colour::kVermillion, Dash::solid, Mark::none, 2.5};
const Pen kFit{colour::kGrey, Dash::dashed, Mark::none, 1.2};

/// Draws the ratios of one CV and one parameter for each multiplier.
Panel ratio_panel(const Study& study, const S0Curve& curve, const std::string& parameter,
                  const std::vector<RatioSpread>& spreads) {
  const S0PerturbationOptions& options = study.s0_perturbation;
  const std::string cv = cv_name(study, curve.cv);
  PanelScript panel(fmt::format("s0_{}_{}", parameter == "damping" ? "damping" : "time", curve.cv),
                    fmt::format("{}: {} ({} experiments)", as_label(cv), parameter, curve.experiments),
                    {.label = "multiplier of the " + parameter},
                    {.label = "Ivar_{diag} modified / true", .logarithmic = true});
  panel.upright_band(options.tolerance_lower, options.tolerance_upper);
  panel.across(study.diagnosis.impact_lower, kImpactBand);
  panel.across(study.diagnosis.impact_upper, kImpactBand);
  const auto draw = [&](double RatioSpread::*value, const Pen& pen) {
    std::vector<double> y;
    for (const RatioSpread& spread : spreads)
      y.push_back(spread.*value);
    panel.line(options.multipliers, y, pen);
  };
  draw(&RatioSpread::least, kExtremes);
  draw(&RatioSpread::largest, kExtremes);
  draw(&RatioSpread::lower_quartile, kQuartiles);
  draw(&RatioSpread::upper_quartile, kQuartiles);
  draw(&RatioSpread::median, kMedian);
  return panel.finish(fmt::format(
      "Ivar_diag of {} with a modified S0 divided by that with the true one, against the multiplier of the "
      "{}: median, quartiles, smallest and largest over the experiments with the fault on this CV.",
      cv, parameter));
}

Figure ratio_figure(const ReportInput& input) {
  const Study& study = input.campaign.study;
  Figure figure;
  figure.name = "s0-perturbation";
  figure.caption = fmt::format(
      "Ivar_{{diag}} with a modified S_{{0}} divided by that with the true one, over the experiments with "
      "the fault on the CV; shaded: multipliers {:g} to {:g}. Thesis figures 6.27 to 6.29.",
      study.s0_perturbation.tolerance_lower, study.s0_perturbation.tolerance_upper);
  figure.legend = {{"median", kMedian},
                   {"quartiles", kQuartiles},
                   {"smallest and largest", kExtremes},
                   {"band of impact", kImpactBand}};
  for (const S0Curve& curve : input.parts.s0_curves) {
    figure.panels.push_back(ratio_panel(study, curve, "time constant", curve.time_constant));
    figure.panels.push_back(ratio_panel(study, curve, "damping", curve.damping));
  }
  return figure;
}

/// Returns the diagonal step response of `cv` in T0, with 0 before the first sample.
std::vector<double> diagonal_response(const NominalSensitivity& sensitivity, Eigen::Index cv) {
  std::vector<double> response{0.0};
  for (std::size_t a = 0; a < sensitivity.active.size(); ++a)
    if (sensitivity.active[a].cv == cv)
      for (const double value : sensitivity.step_response[a].row(cv))
        response.push_back(value);
  return response;
}

Panel structure_panel(const ReportInput& input, const StructureFit& fit) {
  const Study& study = input.campaign.study;
  const BasisCase& basis = input.campaign.basis;
  const double Ts = study.controller.sample_time;
  const std::string cv = cv_name(study, fit.cv);
  PanelScript panel(fmt::format("structure_{}", fit.cv), "T_{0} of " + as_label(cv),
                    {.label = "time (" + as_label(unit_text(study.plant.time_unit)) + ")"},
                    {.label = "response per unit step"});
  const auto draw = [&](const std::vector<double>& y, const Pen& pen) {
    std::vector<double> time;
    for (std::size_t l = 0; l < y.size(); ++l)
      time.push_back(Ts * static_cast<double>(l));
    panel.line(time, y, pen);
  };
  const std::vector<double> available = diagonal_response(basis.sensitivity, fit.cv);
  const std::vector<double> fixed = diagonal_response(*basis.sensitivity_fixed, fit.cv);
  for (const SecondOrderFit* of : {&fit.available, &fit.fixed}) {
    if (of->status != FitStatus::ok)
      continue;
    const Eigen::RowVectorXd model =
        second_order_response(of->model, Ts, static_cast<Eigen::Index>(available.size()) - 1);
    std::vector<double> y{0.0};
    y.insert(y.end(), model.begin(), model.end());
    draw(y, kFit);
  }
  draw(available, kAvailable);
  draw(fixed, kFixed);
  return panel.finish(fmt::format("Step response of the diagonal of T0 of {} with {} available and fixed.",
                                  cv, fixed_names(study)));
}

Figure structure_figure(const ReportInput& input) {
  const std::string fixed = fixed_names(input.campaign.study);
  Figure figure;
  figure.name = "s0-structure";
  figure.caption = fmt::format(
      "Diagonal of T_{{0}} = I - S_{{0}} with {} available and with it fixed, and the fits of (6.24); thesis "
      "figure 6.32.",
      fixed);
  figure.legend = {{fixed + " available", kAvailable}, {fixed + " fixed", kFixed}, {"fit", kFit}};
  for (const StructureFit& fit : input.parts.structure_fits)
    figure.panels.push_back(structure_panel(input, fit));
  return figure;
}

}  // namespace

Section s0_perturbation_section(const ReportInput& input) {
  Section section{"s0-perturbation", "What does an error in S_{0} cost?", {}};
  if (input.campaign.study.s0_perturbation.multipliers.empty()) {
    section.leave_out("the study does not perturb S0 (s0_perturbation).");
    return section;
  }
  section.answer = s0_answer(input);
  if (input.parts.s0_curves.empty())
    section.leave_out("there is no feasible experiment whose fault is on a CV at a soft limit.");
  else
    section.add(ratio_figure(input));
  if (!input.parts.s0_fits.empty())
    section.add(s0_change_table(input.campaign.study, input.parts));
  if (!input.parts.structure_fits.empty()) {
    section.add(structure_figure(input));
    section.add(s0_structure_table(input.campaign.study, input.parts));
  }
  return section;
}

}  // namespace mpm
