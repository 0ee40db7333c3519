#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/summary/summary_sections.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

/// An index of every CV, one line a scenario; a star marks what lies outside the band of impact.
void add_scenario_indices(SummaryLines& text, const Campaign& campaign, const char* name,
                          Eigen::VectorXd Diagnosis::*index) {
  const Study& study = campaign.study;
  const auto row = [&](const std::string& first, const std::vector<std::string>& cells) {
    std::string line = fmt::format("{:<14}", first);
    for (const std::string& cell : cells)
      line += fmt::format("  {:>9}", cell);
    text.line("{}", line);
  };
  text.line("");
  std::vector<std::string> cells;
  for (const PlantModel::Variable& cv : study.plant.cvs)
    cells.push_back(cv.name + " ");
  row(name, cells);
  for (const ExperimentRecord& record : campaign.records) {
    cells.clear();
    const Diagnosis chain = record.chain();
    for (const double value : chain.*index)
      cells.push_back(digits_text(value) + (study.diagnosis.has_impact(value) ? "*" : " "));
    row(scenario_name(study, record), cells);
  }
}

/// The indicators of the flagged CVs.
void add_scenario_indicators(SummaryLines& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  constexpr auto kRow = "{:<14}  {:<10}  {:>8}  {:>8}  {:>8}  {:>8}";
  text.line("");
  text.line(kRow, "flagged CVs", "CV", "I_MPM", "co_dkts", "co_dskn", "SSE");
  for (const ExperimentRecord& record : campaign.records) {
    const Diagnosis chain = record.chain();
    for (std::size_t i = 0; i < chain.cvs.size(); ++i) {
      const CvDiagnosis& cv = chain.cvs[i];
      if (cv.flagged)
        text.line(kRow, scenario_name(study, record), study.plant.cvs[i].name,
                  digits_text(cv.distribution.mpm.i_mpm), digits_text(cv.distribution.mpm.co_dkts),
                  digits_text(cv.distribution.mpm.co_dskn), digits_text(cv.sse));
    }
  }
  text.line("(* outside the band of impact)");
}

/// The CVs whose autocorrelation functions differ from those of their nominal outputs.
void add_autocorrelations(SummaryLines& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  constexpr auto kRow = "{:<14}  {:<10}  {:>8}  {:>8}  {:>8}  {}";
  text.line("");
  text.line(kRow, "ACF", "CV", "lag y", "lag y0", "own", "verdict");
  bool any = false;
  const auto row = [&](const std::string& name, std::size_t cv, const AcfComparison& acf) {
    if (!acf_differs(acf))
      return;
    any = true;
    text.line(kRow, name, study.plant.cvs[cv].name, digits_text(acf.y.decay_lag),
              digits_text(acf.y0.decay_lag), digits_text(acf.own_share), acf_text(acf));
  };
  const auto rows = [&](const std::string& name, const Diagnosis& chain) {
    for (std::size_t cv = 0; cv < chain.cvs.size(); ++cv)
      row(name, cv, chain.cvs[cv].acf);
  };
  rows("basis case", campaign.basis.diagnosis);
  for (const ExperimentRecord& record : campaign.records)
    rows(scenario_name(study, record), record.chain());
  text.line("({}; lags in samples; own: 1 when y0_diag is like y0, 0 when it is like y)",
            any ? "CVs that differ from their nominal output" : "no CV differs from its nominal output");
}

}  // namespace

void add_scenarios(SummaryLines& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  const DiagnosisOptions& options = study.diagnosis;
  constexpr auto kRow = "{:<14}  {:<24}  {:<24}  {:>8}  {}";
  text.line("");
  text.line(kRow, "named scenarios", "affected", "flagged", "TSSE", "verdict");
  for (const ExperimentRecord& record : campaign.records) {
    const Diagnosis chain = record.chain();
    text.line(kRow, scenario_name(study, record), affected_text(study, record.draw),
              flagged_text(study, chain), digits_text(total_simulation_error(chain)),
              scenario_verdict_text(study, record));
  }
  text.line("(flagged: Ivar_diag outside {:g} to {:g}; source by I_MPM above or below {:g})",
            options.impact_lower, options.impact_upper, options.mpm_threshold);
  add_scenario_indices(text, campaign, "Ivar", &Diagnosis::ivar);
  add_scenario_indices(text, campaign, "Ivar_diag", &Diagnosis::ivar_diag);
  add_scenario_indicators(text, campaign);
  add_autocorrelations(text, campaign);
}

}  // namespace mpm
