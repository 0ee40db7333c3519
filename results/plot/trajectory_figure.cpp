#include "results/plot/trajectory_figure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/non_finite.hpp"
#include "results/archive/variable_text.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

constexpr double kHeight = 210;  // pixels

const Pen kRecorded{colour::kBlack, Dash::solid, Mark::none, 1.0};
const Pen kNominal{colour::kSky, Dash::solid, Mark::none, 3.5};
const Pen kSetpoint{colour::kGreen, Dash::solid, Mark::none, 1.5};
const Pen kTarget{colour::kGreen, Dash::dashed, Mark::none, 1.5};
const Pen kSoftLimit{colour::kPurple, Dash::dashed, Mark::none, 1.2};
const Pen kHardLimit{colour::kVermillion, Dash::dotted, Mark::none, 1.5};

std::vector<double> row(const Eigen::MatrixXd& signal, Eigen::Index i, Eigen::Index samples) {
  const Eigen::VectorXd values = signal.row(i).head(samples);
  return {values.begin(), values.end()};
}

/// What all panels of one loop have in common.
struct Setting {
  const Study& study;
  Eigen::Index samples;
  std::vector<double> time;
  Axis time_axis;

  Setting(const Study& of, const Trajectory& loop) : study(of), samples(loop.samples_done) {
    const double sample_time = study.controller.sample_time;
    for (Eigen::Index k = 0; k < samples; ++k)
      time.push_back(sample_time * static_cast<double>(k));
    time_axis.label = "time (" + as_label(unit_text(study.plant.time_unit)) + ")";
    time_axis.lower = 0.0;
    time_axis.upper = sample_time * static_cast<double>(study.simulation.samples);
  }

  PanelScript panel(const char* group, Eigen::Index i, const PlantModel::Variable& variable) const {
    const std::string name = as_label(variable.name);
    const std::string unit = variable.unit.empty() || variable.unit == "1" ? "-" : as_label(variable.unit);
    const std::string about = variable.description.empty() ? "" : ": " + as_label(variable.description);
    return {fmt::format("{}{}", group, i), name + about, time_axis, {name + " (" + unit + ")"}};
  }
};

/// The range in which a panel shows limits: the range of the signals, and as much again on either side.
/// Otherwise a CV that moves little would be a flat line between its limits.
struct Reach {
  double lower = -kInfinity, upper = kInfinity;

  /// If the signals stand still, every limit is within reach.
  explicit Reach(const std::vector<std::vector<double>>& signals) {
    double least = kInfinity, largest = -kInfinity;
    for (const std::vector<double>& signal : signals)
      for (const double value : signal)
        if (std::isfinite(value)) {
          least = std::min(least, value);
          largest = std::max(largest, value);
        }
    if (const double span = largest - least; span > 0.0) {
      lower = least - span;
      upper = largest + span;
    }
  }
};

void add_limits(PanelScript& panel, const Limits& limits, Eigen::Index i, const Reach& reach,
                const Pen& pen) {
  for (const double limit : {limits.lower(i), limits.upper(i)})
    if (limit >= reach.lower && limit <= reach.upper)
      panel.across(limit, pen);
}

Panel cv_panel(const Setting& at, const Trajectory& loop, const NominalOutputs& nominal, Eigen::Index i) {
  const PlantModel::Variable& variable = at.study.plant.cvs[static_cast<std::size_t>(i)];
  PanelScript panel = at.panel("cv", i, variable);
  const std::vector<double> y = row(loop.y, i, at.samples), y0 = row(nominal.y0, i, at.samples);
  const Reach reach({y, y0});
  add_limits(panel, at.study.controller.cv_hard, i, reach, kHardLimit);
  add_limits(panel, at.study.controller.cv_soft, i, reach, kSoftLimit);
  panel.line(at.time, y0, kNominal);  // first, so that it lies below the thinner line
  if (at.study.controller.has_setpoint(i))
    panel.steps(at.time, row(loop.y_set, i, at.samples), kSetpoint);
  panel.line(at.time, y, kRecorded);
  return panel.finish(fmt::format("Controlled variable {} and its nominal output over time.", variable.name),
                      kHeight);
}

Panel mv_panel(const Setting& at, const Trajectory& loop, Eigen::Index i) {
  const PlantModel::Variable& variable = at.study.plant.mvs[static_cast<std::size_t>(i)];
  PanelScript panel = at.panel("mv", i, variable);
  const std::vector<double> u = row(loop.u, i, at.samples);
  add_limits(panel, at.study.controller.mv_hard, i, Reach({u}), kHardLimit);
  if (at.study.controller.has_targets())
    panel.steps(at.time, row(loop.u_target, i, at.samples), kTarget);
  panel.steps(at.time, u, kRecorded);
  return panel.finish(fmt::format("Manipulated variable {} and its target over time.", variable.name),
                      kHeight);
}

Panel md_panel(const Setting& at, const Trajectory& loop, Eigen::Index i) {
  const PlantModel::Variable& variable = at.study.plant.mds[static_cast<std::size_t>(i)];
  PanelScript panel = at.panel("md", i, variable);
  panel.steps(at.time, row(loop.d, i, at.samples), kRecorded);
  return panel.finish(fmt::format("Measured disturbance {} over time.", variable.name), kHeight);
}

}  // namespace

Figure trajectory_figure(const Study& study, const Trajectory& loop, const NominalOutputs& nominal,
                         const std::string& name) {
  const Setting setting(study, loop);
  Figure figure;
  figure.name = name;
  figure.legend = {
      {"recorded CV, MV or MD", kRecorded}, {"nominal output, y_{0}", kNominal}, {"hard limit", kHardLimit}};
  if (study.controller.has_setpoints())
    figure.legend.push_back({"setpoint of the CV", kSetpoint});
  if (study.controller.has_targets())
    figure.legend.push_back({"target of the MV", kTarget});
  if (study.controller.has_soft_limits())
    figure.legend.push_back({"soft limit of the CV", kSoftLimit});
  for (Eigen::Index i = 0; i < study.cv_count(); ++i)
    figure.panels.push_back(cv_panel(setting, loop, nominal, i));
  for (Eigen::Index i = 0; i < study.mv_count(); ++i)
    figure.panels.push_back(mv_panel(setting, loop, i));
  for (Eigen::Index i = 0; i < study.md_count(); ++i)
    figure.panels.push_back(md_panel(setting, loop, i));
  return figure;
}

}  // namespace mpm
