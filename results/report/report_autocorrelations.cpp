#include <utility>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

const Pen kY{colour::kBlack, Dash::solid, Mark::none, 1.5};
const Pen kY0{colour::kBlue, Dash::dashed, Mark::none, 1.8};
const Pen kY0Diag{colour::kVermillion, Dash::dotted, Mark::none, 2.0};
const Pen kWhiteBand{colour::kLightGrey, Dash::solid, Mark::none, 1.0};

constexpr std::size_t kFewCvs = 3;  // of so many CVs all are drawn

/// What the chain says of one loop, under its name.
struct Loop {
  std::string id;
  std::string name;
  Diagnosis chain;
  std::vector<std::size_t> drawn;  ///< which CVs are drawn
};

std::vector<Loop> loops_of(const Campaign& campaign) {
  std::vector<Loop> loops;
  if (!campaign.basis.diagnosis.cvs.empty())
    loops.push_back({"basis", "basis case", campaign.basis.diagnosis, {}});
  const std::size_t basis = loops.size();
  for (const ExperimentRecord& record : campaign.records)
    loops.push_back(
        {fmt::format("{}", record.draw.index), scenario_name(campaign.study, record), record.chain(), {}});
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t cv = 0; cv < loops[i].chain.cvs.size(); ++cv)
      if (i < basis || loops[i].chain.cvs[cv].flagged || loops[i].chain.cvs.size() <= kFewCvs)
        loops[i].drawn.push_back(cv);
  return loops;
}

Panel acf_panel(const Study& study, std::size_t cv, const AcfComparison& acf) {
  const std::string& name = study.plant.cvs[cv].name;
  std::vector<double> lags;
  for (Eigen::Index lag = 0; lag < acf.y.values.size(); ++lag)
    lags.push_back(static_cast<double>(lag));
  PanelScript panel(fmt::format("acf_{}", cv), fmt::format("{}: {}", as_label(name), as_label(acf_text(acf))),
                    {.label = "lag (samples)", .lower = 0.0},
                    {.label = "autocorrelation", .lower = -1.0, .upper = 1.0});
  panel.across(acf.white_band, kWhiteBand);
  panel.across(-acf.white_band, kWhiteBand);
  for (const auto& [values, pen] : {std::pair{&acf.y.values, &kY}, std::pair{&acf.y0.values, &kY0},
                                    std::pair{&acf.y0_diag.values, &kY0Diag}})
    panel.line(lags, std::vector<double>(values->begin(), values->end()), *pen);
  return panel.finish(fmt::format("Autocorrelation of y, y0 and y0_diag of {}.", name), 240);
}

Figure acf_figure(const Study& study, const Loop& loop) {
  Figure figure;
  figure.name = "scenario-acf-" + loop.id;
  figure.caption = fmt::format(
      "{}: autocorrelation about the setpoint, or the mean of a CV without one, with the band of white "
      "noise; section 3.2 of the thesis, figure A2.1.",
      as_label(loop.name));
  figure.legend = {{"y", kY}, {"y_{0}", kY0}, {"y_{0 diag}", kY0Diag}, {"white noise", kWhiteBand}};
  for (const std::size_t cv : loop.drawn)
    figure.panels.push_back(acf_panel(study, cv, loop.chain.cvs[cv].acf));
  return figure;
}

}  // namespace

void add_autocorrelations(Section& section, const Campaign& campaign) {
  const std::vector<Loop> loops = loops_of(campaign);
  if (Table table = acf_table(campaign); table.rows.empty())
    section.say("The autocorrelation functions of no CV differ from those of its nominal output.");
  else
    section.add(std::move(table));
  for (const Loop& loop : loops)
    if (!loop.drawn.empty())
      section.add(acf_figure(campaign.study, loop));
}

}  // namespace mpm
