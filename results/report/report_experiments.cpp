#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostExperiments = 1000;

/// "right", "wrong", or why it was not judged.
std::string outcome_cell(const Study& study, const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  const AssessmentRecord& chain = *record.by(kChainMethod);
  if (!chain.flagged)
    return is_faultless(record.draw.kind) ? "right" : "no impact";
  return judge(study, record, chain).wrong() ? "<span class=\"no\">wrong</span>" : "right";
}

/// The index of the true CV; without a fault, the one that is farthest from 1.
double index_of(const Study& study, const ExperimentRecord& record, const Eigen::VectorXd& values) {
  const Eigen::Index cv = record.draw.true_cv() >= 0
                              ? record.draw.true_cv()
                              : farthest_from_one(values, study.diagnosis.location_distance);
  return cv >= 0 && cv < values.size() ? values(cv) : NAN;
}

}  // namespace

std::int64_t listed_below(const Campaign& campaign) {
  std::size_t place = 0;
  std::int64_t below = std::numeric_limits<std::int64_t>::max();
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (place++ == kMostExperiments)
      below = record.draw.index;
  });
  return below;
}

std::string experiment_anchor(const ReportInput& input, const ExperimentRecord& record) {
  const Campaign& campaign = input.campaign;
  return record.draw.index < input.listed_below && chain_place(campaign) < campaign.methods.size() &&
                 !campaign.study.names_scenarios()
             ? fmt::format("experiment-{}", record.draw.index)
             : "";
}

ReportSection experiments_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  const Study& study = campaign.study;
  ReportSection section{"experiments", "Experiments, one by one", {}};
  const std::size_t experiments = records_of(campaign).size();
  if (experiments == 0) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  HtmlTable table(
      "What was wrong in each loop, and what the chain of the thesis says of it. Ivar, Ivar<sub>diag</sub> "
      "and "
      "Ivar<sub>basis</sub> are those of the CV with the fault.",
      {{"No."},
       {"Kind", HtmlTable::Align::left},
       {"Fault", HtmlTable::Align::text},
       {"True CV", HtmlTable::Align::left},
       {"Located", HtmlTable::Align::left},
       {"Source", HtmlTable::Align::left},
       {"Verdict", HtmlTable::Align::left},
       {"I<sub>MPM</sub>"},
       {"Ivar"},
       {"Ivar<sub>diag</sub>"},
       {"Ivar<sub>basis</sub>"}});
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (record.draw.index >= input.listed_below)
      return;
    const Diagnosis chain = record.chain();
    const std::string number = fmt::format("{}", record.draw.index);
    table.row(
        {input.shows_loop(record.draw.index) ? fmt::format("<a href=\"#loop-{0}\">{0}</a>", number) : number,
         kind_name(record.draw.kind), html_text(fault_text(study, record.draw)),
         html_text(cv_name(study, record.draw.true_cv())),
         chain.impactful ? html_text(cv_name(study, chain.predicted_cv)) : html_number(NAN),
         chain.impactful ? source_name(chain.predicted_source) : html_number(NAN),
         outcome_cell(study, record), html_number(chain.impactful ? chain.indicator.i_mpm : NAN),
         html_number(index_of(study, record, chain.ivar)),
         html_number(index_of(study, record, chain.ivar_diag)),
         html_number(index_of(study, record, record.ivar_basis))},
        experiment_anchor(input, record));
  });
  if (experiments > kMostExperiments)
    section.add(fmt::format(
        "<p>The first {} of {}; <code>mpmbench export {} --table experiments</code> writes all.</p>\n",
        kMostExperiments, experiments, html_text(input.file)));
  section.add(table.html());
  return section;
}

}  // namespace mpm
