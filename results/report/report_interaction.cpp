#include <vector>

#include <fmt/format.h>

#include "analysis/sensitivity/loop_interaction.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kPeak{colour::kGrey, Dash::dashed, Mark::none, 1.0};

std::vector<double> numbers(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

Axis frequency_axis(const Study& study) {
  return {.label = "frequency (rad/" + as_label(study.plant.time_unit) + ")", .logarithmic = true};
}

Panel rpn_panel(const Study& study, const LoopInteraction& interaction) {
  PanelScript panel("rpn", "RPN weight function", frequency_axis(study), {.label = "RPN"});
  panel.upright(interaction.rpn_frequency, kPeak);
  panel.line(numbers(interaction.frequency), numbers(interaction.rpn), {});
  return panel.finish(fmt::format("RPN against frequency; largest, {:.3g}, at {:.3g} rad/{}.",
                                  interaction.rpn_maximum, interaction.rpn_frequency, study.plant.time_unit));
}

Panel rga_panel(const Study& study, const LoopInteraction& interaction) {
  PanelScript panel("rga", "diagonal of the RGA, magnitudes", frequency_axis(study),
                    {.label = "magnitude", .lower = 0.0});
  panel.upright(interaction.rpn_frequency, kPeak);
  for (std::size_t i = 0; i < interaction.cvs.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    std::vector<double> gains;
    for (const Eigen::MatrixXd& gain : interaction.relative_gain)
      gains.push_back(gain(at, at));
    panel.line(numbers(interaction.frequency), gains, cv_pen(interaction.cvs[i]));
  }
  return panel.finish("Magnitude of each diagonal element of the dynamic RGA against frequency.");
}

/// The RGA at the frequency of the largest RPN.
Table relative_gain_table(const Study& study, const LoopInteraction& interaction) {
  Table table(fmt::format("Magnitudes of the RGA at {:.3g} rad/{}", interaction.rpn_frequency,
                          as_label(study.plant.time_unit)),
              {{"", Table::Align::left}});
  for (const Eigen::Index mv : interaction.mvs)
    table.columns.push_back({as_label(mv_name(study, mv))});
  for (std::size_t i = 0; i < interaction.cvs.size(); ++i) {
    std::vector<Cell> cells{as_label(cv_name(study, interaction.cvs[i]))};
    for (const double gain : interaction.relative_gain_at_maximum.row(static_cast<Eigen::Index>(i)))
      cells.emplace_back(fixed(gain));
    table.row(std::move(cells));
  }
  return table;
}

}  // namespace

Section interaction_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const BasisCase& basis = input.campaign.basis;
  const LoopInteraction interaction = loop_interaction(study, basis.point, basis.sensitivity);
  Section section{"interaction", "How strongly do the loops interact?", {}};
  if (interaction.frequency.size() == 0) {
    section.leave_out(interaction.cvs.empty() ? "no CV is at a setpoint or a soft limit, so T_0 is zero."
                                              : "T_0 has numbers that are not finite.");
    return section;
  }
  section.answer = interaction_answer(input, interaction);
  Figure figure;
  figure.name = "interaction";
  figure.caption =
      "RPN = largest singular value of S_{0} T_{0} (4.16), up to the Nyquist frequency. It is largest near "
      "the frequencies at which the controller works (dashed); thesis figures 4.6, 4.12.";
  figure.panels.push_back(rpn_panel(study, interaction));
  if (!interaction.mvs.empty()) {
    figure.caption +=
        " Diagonal of the dynamic RGA of G_{0}: far from 1 where loops interact; thesis figures 4.5, 4.11.";
    for (std::size_t i = 0; i < interaction.cvs.size(); ++i)
      figure.legend.push_back({as_label(fmt::format("{} with {}", cv_name(study, interaction.cvs[i]),
                                                    mv_name(study, interaction.mvs[i]))),
                               cv_pen(interaction.cvs[i])});
    figure.panels.push_back(rga_panel(study, interaction));
  }
  section.add(std::move(figure));
  if (interaction.mvs.empty())
    section.say(fmt::format(
        "No RGA: it needs as many MVs that can move as CVs at a setpoint or soft limit, {}, and a "
        "model between them that has an inverse.",
        interaction.cvs.size()));
  else
    section.add(relative_gain_table(study, interaction));
  return section;
}

}  // namespace mpm
