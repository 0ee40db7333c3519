#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

const Pen kKurtosis{colour::kBlue, Dash::none, Mark::dot, 1.0, 0.7};
const Pen kSkewness{colour::kVermillion, Dash::none, Mark::triangle, 1.0, 0.7};
const Pen kError{colour::kBlue, Dash::none, Mark::square, 1.0, 0.7};
const Pen kOutsideAffected{colour::kSky, Dash::none, Mark::square, 1.0, 1.2};
const Pen kOutsideOnly{colour::kOrange, Dash::none, Mark::square, 1.0, 1.2};
const Pen kOutside{colour::kGreen, Dash::none, Mark::square, 1.0, 1.2};

constexpr double kRowHeight = 24;  // pixels

/// Formats a value with few digits, so that it fits into a field of a heat map.
std::string field_number(double value) {
  if (!std::isfinite(value))
    return "-";
  return fmt::format("{:.{}f}", value, value < 9.995 ? 2 : value < 99.95 ? 1 : 0);
}

bool is_affected(const ExperimentRecord& record, Eigen::Index cv) {
  const std::vector<AffectedCv> affected = record.draw.affected();
  return std::any_of(affected.begin(), affected.end(), [cv](const auto& a) { return a.cv == cv; });
}

/// Returns an axis with a word for each row, the first one on top.
Axis rows_axis(std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());
  const auto last = static_cast<double>(words.size()) - 1.0;
  return {.label = "", .lower = -0.5, .upper = last + 0.5, .words = std::move(words)};
}

std::vector<std::string> scenario_words(const Campaign& campaign) {
  std::vector<std::string> words;
  for (const ExperimentRecord& record : campaign.records)
    words.push_back(as_label(scenario_name(campaign.study, record)));
  return words;
}

/// Returns the depth of the colour of an index. It is deepest at a factor of 4 from 1.
double depth_of_index(double index) {
  return std::clamp(0.2 + 0.6 * std::abs(std::log(index)) / std::log(4.0), 0.2, 0.8);
}

/// Draws one field per CV and scenario, coloured outside the band of impact. With `judged`, affected CVs are
/// blue and others orange, and an affected CV within the band stands in brackets.
Panel index_panel(const Campaign& campaign, const char* name, const char* title, bool judged) {
  const Study& study = campaign.study;
  const std::vector<std::string> words = scenario_words(campaign);
  const auto last = static_cast<double>(words.size()) - 1.0;
  Axis cvs{.label = "", .lower = -0.5, .upper = static_cast<double>(study.cv_count()) - 0.5};
  for (const PlantModel::Variable& cv : study.plant.cvs)
    cvs.words.push_back(as_label(cv.name));
  PanelScript panel(name, title, cvs, rows_axis(words));
  for (std::size_t row = 0; row < campaign.records.size(); ++row) {
    const ExperimentRecord& record = campaign.records[row];
    const Eigen::MatrixXd values = record.chain().values(name);
    for (Eigen::Index cv = 0; cv < values.size(); ++cv) {
      const bool outside = study.diagnosis.has_impact(values(cv));
      const bool affected = judged && is_affected(record, cv);
      const std::string_view fill = !judged ? colour::kGreen : affected ? colour::kSky : colour::kOrange;
      const std::string number = field_number(values(cv));
      panel.field(static_cast<double>(cv), last - static_cast<double>(row), fill,
                  outside ? depth_of_index(values(cv)) : 0.0,
                  affected && !outside ? "[" + number + "]" : number);
    }
  }
  return panel.finish(
      fmt::format("{} of every CV and scenario as a heat map; the table below has the numbers.", title),
      60.0 + kRowHeight * (last + 1.0));
}

Figure index_figure(const Campaign& campaign) {
  const DiagnosisOptions& options = campaign.study.diagnosis;
  Figure figure;
  figure.name = "scenario-ivar";
  figure.caption = fmt::format(
      "Ivar and Ivar_{{diag}} of every CV; thesis figures 6.12 and 6.13. Coloured: outside the band of "
      "impact, {:g} to {:g}, deeper the farther from 1. [Brackets]: an affected CV within the band.",
      options.impact_lower, options.impact_upper);
  figure.legend = {{"Ivar outside the band", kOutside},
                   {"Ivar_{diag} outside the band, CV affected", kOutsideAffected},
                   {"Ivar_{diag} outside the band, CV not affected", kOutsideOnly}};
  figure.panels = {index_panel(campaign, "ivar", "Ivar", false),
                   index_panel(campaign, "ivar_diag", "Ivar_{diag}", true)};
  return figure;
}

/// co_dkts and co_dskn of the affected and of the flagged CVs, one row each.
struct IndicatorRows {
  std::vector<std::string> words;
  std::vector<NamedPoint> kurtosis, skewness;

  explicit IndicatorRows(const Campaign& campaign) {
    for (const ExperimentRecord& record : campaign.records) {
      for (Eigen::Index cv = 0; record.chain().answered() && cv < campaign.study.cv_count(); ++cv)
        if (record.chain().flags(cv) || is_affected(record, cv))
          add(campaign.study, record, cv);
    }
    // The first row is on top.
    for (std::vector<NamedPoint>* points : {&kurtosis, &skewness})
      for (NamedPoint& point : *points)
        point.y = static_cast<double>(words.size()) - 1.0 - point.y;
  }

 private:
  void add(const Study& study, const ExperimentRecord& record, Eigen::Index cv) {
    const AssessmentRecord& chain = record.chain();
    std::string truth = "not affected";
    for (const AffectedCv& affected : record.draw.affected())
      if (affected.cv == cv)
        truth = source_name(affected.by) + (chain.flags(cv) ? "" : ", missed");
    const std::string name =
        fmt::format("{} {} ({})", scenario_name(study, record), cv_name(study, cv), truth);
    const auto row = static_cast<double>(words.size());
    for (const auto& [points, number] : {std::pair{&kurtosis, "co_dkts"}, std::pair{&skewness, "co_dskn"}}) {
      const double value = chain.number(std::string("cv_") + number, cv);
      points->push_back({value, row, fmt::format("{}: {} {:.3f}", name, number, value)});
    }
    words.push_back(as_label(name));
  }
};

Panel indicator_panel(const Study& study, const IndicatorRows& rows) {
  PanelScript panel("co", "source of the affected and flagged CVs",
                    {.label = "correlation (-)", .lower = 0.0}, rows_axis(rows.words));
  panel.upright(mpm_threshold(study), kThreshold);
  panel.points(rows.skewness, kSkewness);
  panel.points(rows.kurtosis, kKurtosis);
  return panel.finish("co_dkts and co_dskn of the affected and the flagged CVs of each scenario.",
                      80.0 + kRowHeight * static_cast<double>(rows.words.size()));
}

Panel error_panel(const Campaign& campaign) {
  const std::vector<std::string> words = scenario_words(campaign);
  std::vector<NamedPoint> errors;
  for (std::size_t row = 0; row < campaign.records.size(); ++row) {
    const double tsse = total_simulation_error(campaign.records[row].chain());
    errors.push_back(
        {tsse, static_cast<double>(words.size() - 1 - row),
         fmt::format("{}: TSSE {:.3g}", scenario_name(campaign.study, campaign.records[row]), tsse)});
  }
  PanelScript panel("tsse", "model error", {.label = "TSSE (CV units)", .lower = 0.0}, rows_axis(words));
  panel.points(errors, kError);
  return panel.finish("TSSE of each scenario.", 80.0 + kRowHeight * static_cast<double>(words.size()));
}

Figure indicator_figure(const Campaign& campaign, const IndicatorRows& rows) {
  Figure figure;
  figure.name = "scenario-indicators";
  figure.caption = fmt::format(
      "Left: total simulation error (6.21); thesis figure 6.11. Right: co_{{dkts}} and co_{{dskn}} of the "
      "affected and of the flagged CVs, with what is wrong in brackets; thesis figure 6.15. The verdict is "
      "MPM when the larger exceeds {:g}.",
      mpm_threshold(campaign.study));
  figure.legend = {
      {"TSSE", kError}, {"co_{dkts}", kKurtosis}, {"co_{dskn}", kSkewness}, {"threshold", kThreshold}};
  figure.panels = {error_panel(campaign)};
  if (!rows.words.empty())
    figure.panels.push_back(indicator_panel(campaign.study, rows));
  return figure;
}

}  // namespace

void add_scenario_figures(Section& section, const Campaign& campaign) {
  section.add(index_figure(campaign));
  section.add(indicator_figure(campaign, IndicatorRows(campaign)));
}

}  // namespace mpm
