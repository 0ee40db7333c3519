#include <optional>

#include <fmt/format.h>

#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "results/archive/variable_text.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// The pen of the direct step responses, which are drawn below the identified ones.
const Pen kDirect{colour::kLightGrey, Dash::solid, Mark::none, 4.0};

Panel step_panel(const Study& study, const NominalSensitivity& sensitivity,
                 const std::optional<NominalSensitivity>& direct, std::size_t a) {
  const ActiveConstraint& constraint = sensitivity.active[a];
  const Eigen::MatrixXd& response = sensitivity.step_response[a];
  std::vector<double> time{0.0};
  for (Eigen::Index l = 0; l < response.cols(); ++l)
    time.push_back(study.controller.sample_time * static_cast<double>(l + 1));
  const std::string cv = cv_name(study, constraint.cv);
  PanelScript panel(fmt::format("t0_{}", a),
                    fmt::format("step of the {} of {}", to_string(constraint.kind), as_label(cv)),
                    {.label = "time (" + as_label(unit_text(study.plant.time_unit)) + ")",
                     .lower = 0.0,
                     .upper = time.back()},
                    {.label = "response per unit step"});
  const auto draw = [&](const Eigen::MatrixXd& of, Eigen::Index row, const Pen& pen) {
    std::vector<double> y{0.0};
    y.insert(y.end(), of.row(row).begin(), of.row(row).end());
    panel.line(time, y, pen);
  };
  if (direct)
    for (Eigen::Index i = 0; i < response.rows(); ++i)
      draw(direct->step_response[a], i, kDirect);
  for (Eigen::Index i = 0; i < response.rows(); ++i)
    draw(response, i, cv_pen(i, i == constraint.cv));
  return panel.finish(
      fmt::format("Responses of all CVs to a unit step of the {} of {}.", to_string(constraint.kind), cv));
}

}  // namespace

Section sensitivity_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const NominalSensitivity& sensitivity = input.campaign.basis.sensitivity;
  const std::optional<NominalSensitivity>& direct = input.campaign.basis.sensitivity_direct;
  Section section{"sensitivity", "Nominal sensitivity T_{0}", {}};
  Figure figure;
  figure.name = "t0";
  figure.caption =
      "Step responses of T_{0} = I - S_{0} from each CV at a setpoint or soft limit, the diagonal one thick; "
      "thesis figure 6.10. T_{0} from the other CVs is zero.";
  for (Eigen::Index i = 0; i < study.cv_count(); ++i)
    figure.legend.push_back({as_label(cv_name(study, i)), cv_pen(i)});
  if (direct)
    figure.legend.push_back({"direct step response", kDirect});
  for (std::size_t a = 0; a < sensitivity.active.size() && a < sensitivity.step_response.size(); ++a)
    if (sensitivity.step_response[a].size() > 0)
      figure.panels.push_back(step_panel(study, sensitivity, direct, a));
  if (figure.panels.empty())
    section.leave_out("no CV is at a setpoint or a soft limit, so T_0 is zero.");
  else
    section.add(std::move(figure));
  if (direct)
    section.say("T_{0} is identified (appendix A3). " + identification_words(study, input.campaign.basis) +
                ".");
  return section;
}

Section basis_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const BasisCase& basis = input.campaign.basis;
  Section section{"basis", "Basis case", {}};
  if (basis.trajectory.samples_done == 0) {
    section.leave_out("the closed loop of the basis case has no samples.");
    return section;
  }
  Figure figure = trajectory_figure(study, basis.trajectory, basis.nominal, "basis-case");
  figure.caption = "The closed loop without mismatch and unmeasured disturbance; thesis figures 6.7 to 6.9.";
  section.add(std::move(figure));
  return section;
}

}  // namespace mpm
