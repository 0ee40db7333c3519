#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

const Pen kY{colour::kBlack, Dash::solid, Mark::none, 1.5};
const Pen kY0{colour::kBlue, Dash::dashed, Mark::none, 1.8};
const Pen kY0Diag{colour::kVermillion, Dash::dotted, Mark::none, 2.0};
const Pen kWhiteBand{colour::kLightGrey, Dash::solid, Mark::none, 1.0};

constexpr Eigen::Index kFewCvs = 3;  // up to this many CVs, all are drawn

/// What the chain says about one loop, and the name of the loop.
struct Loop {
  std::string id;
  std::string name;
  std::map<Eigen::Index, AcfComparison> drawn = {};  ///< CVs to draw
};

std::vector<Loop> loops_of(const Campaign& campaign) {
  std::vector<Loop> loops;
  Loop& basis = loops.emplace_back(Loop{"basis", "basis case"});
  for (const CvDiagnosis& of_cv : campaign.basis.diagnosis.cvs)
    basis.drawn.emplace(std::ssize(basis.drawn), of_cv.acf);
  const Eigen::Index cvs = campaign.study.cv_count();
  for (const ExperimentRecord& record : campaign.records) {
    const AssessmentRecord& chain = record.chain();
    Loop& loop =
        loops.emplace_back(Loop{fmt::format("{}", record.draw.index), scenario_name(campaign.study, record)});
    for (Eigen::Index cv = 0; chain.answered() && cv < cvs; ++cv)
      if (chain.flags(cv) || cvs <= kFewCvs)
        loop.drawn.emplace(cv, cv_diagnosis(chain, cv).acf);
  }
  return loops;
}

Panel acf_panel(const Study& study, Eigen::Index cv, const AcfComparison& acf) {
  const std::string name = cv_name(study, cv);
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
  for (const auto& [cv, acf] : loop.drawn)
    figure.panels.push_back(acf_panel(study, cv, acf));
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
