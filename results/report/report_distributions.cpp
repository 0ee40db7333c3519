#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "analysis/indicators/scatter_ellipse.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

const Pen kKurtosisEllipse{colour::kBlue, Dash::solid, Mark::none, 1.8};
const Pen kSkewnessEllipse{colour::kVermillion, Dash::dashed, Mark::none, 1.8};

constexpr double kProbability = 0.95;
constexpr int kCorners = 72;  // of the polygon that draws an ellipse

template <class Part>
struct Statistic {
  const char* label;
  Part PerStatistic<Part>::*member;
};

template <class Part>
constexpr std::array<Statistic<Part>, 4> kStatistics{{{"kts", &PerStatistic<Part>::kts},
                                                      {"skn", &PerStatistic<Part>::skn},
                                                      {"dkts", &PerStatistic<Part>::dkts},
                                                      {"dskn", &PerStatistic<Part>::dskn}}};

void draw_ellipse(PanelScript& panel, const CentredSums& sums, const Pen& pen) {
  const ConfidenceEllipse ellipse = confidence_ellipse(sums, kProbability);
  const double angle = ellipse.angle * std::numbers::pi / 180.0;
  std::vector<double> x, y;
  for (int corner = 0; corner <= kCorners; ++corner) {
    const double phase = 2.0 * std::numbers::pi * corner / kCorners;
    const double along = ellipse.semi_major * std::cos(phase);
    const double across = ellipse.semi_minor * std::sin(phase);
    x.push_back(ellipse.centre_x + along * std::cos(angle) - across * std::sin(angle));
    y.push_back(ellipse.centre_y + along * std::sin(angle) + across * std::cos(angle));
  }
  panel.line(x, y, pen);
}

/// Draws the ellipses of one CV, either of the moments or of their differences.
Panel ellipse_panel(const std::string& name, const std::string& cv, const PerStatistic<CentredSums>& scatter,
                    bool differences) {
  const char* what = differences ? "differences" : "moments";
  PanelScript panel(name, fmt::format("{}: {}", as_label(cv), what), {.label = "of y_{0 diag}"},
                    {.label = "of e_{0 diag}"});
  draw_ellipse(panel, differences ? scatter.dkts : scatter.kts, kKurtosisEllipse);
  draw_ellipse(panel, differences ? scatter.dskn : scatter.skn, kSkewnessEllipse);
  return panel.finish(
      fmt::format("Confidence ellipses of moving kurtosis and skewness, {}, of {}.", what, cv), 240);
}

/// Calls `visit(name of the CV, results for it)` for each flagged CV.
template <class Visit>
void for_each_flagged(const Campaign& campaign, Visit visit) {
  for (const ExperimentRecord& record : campaign.records) {
    for (Eigen::Index cv = 0; cv < campaign.study.cv_count(); ++cv)
      if (record.chain().flags(cv))
        visit(scenario_name(campaign.study, record) + " " + cv_name(campaign.study, cv),
              cv_diagnosis(record.chain(), cv));
  }
}

Figure ellipse_figure(const Campaign& campaign) {
  Figure figure;
  figure.name = "scenario-ellipses";
  figure.caption = fmt::format(
      "{:g} % confidence ellipses of moving kurtosis and skewness of the nominal error against those of the "
      "nominal output, at a window of one prediction horizon; beside them those of their differences; thesis "
      "figures 5.11 and 5.19. Flat and along an axis: a disturbance; inclined: a mismatch.",
      100.0 * kProbability);
  figure.legend = {{"kurtosis", kKurtosisEllipse}, {"skewness", kSkewnessEllipse}};
  for_each_flagged(campaign, [&](const std::string& cv, const CvDiagnosis& found) {
    for (const bool differences : {false, true})
      figure.panels.push_back(ellipse_panel(fmt::format("ellipse_{}", figure.panels.size()), cv,
                                            found.distribution.scatter_diag, differences));
  });
  return figure;
}

Table distribution_table(const Campaign& campaign) {
  Table table(
      "Indicators of chapter 5 for the flagged CVs: means over the window lengths, of moving kurtosis (kts) "
      "and "
      "skewness (skn) and of their differences (dkts, dskn).",
      {{"Scenario, CV", Table::Align::left},
       {"Of", Table::Align::left},
       {"co"},
       {"ce"},
       {"Angle (degrees)"},
       {"b/a"}});
  for_each_flagged(campaign, [&](const std::string& cv, const CvDiagnosis& found) {
    for (const auto& statistic : kStatistics<ScatterMeans>) {
      const ScatterMeans& means = found.distribution.means.*statistic.member;
      table.row({as_label(cv), statistic.label, fixed(means.co), fixed(means.ce), fixed(means.angle),
                 fixed(means.minor_to_major)});
    }
  });
  return table;
}

}  // namespace

void add_distributions(Section& section, const Campaign& campaign) {
  Figure figure = ellipse_figure(campaign);
  if (figure.panels.empty())
    return;
  section.add(std::move(figure));
  section.add(distribution_table(campaign));
}

}  // namespace mpm
