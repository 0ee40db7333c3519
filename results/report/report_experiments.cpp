#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostExperiments = 1000;

/// "right", "wrong", or why it was not judged.
Cell outcome_cell(const Study& study, const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  const AssessmentRecord& chain = *record.diagnosed();
  if (!chain.flagged)
    return is_faultless(record.draw.kind) ? "right" : "no impact";
  return judge(study, record, chain).wrong() ? Cell("wrong").toned(Cell::Tone::bad) : Cell("right");
}

/// Returns the index of the true CV or, if there is no fault, of the CV whose index is farthest from 1.
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

Section experiments_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  const Study& study = campaign.study;
  Section section{"experiments", "Experiments, one by one", {}};
  const std::size_t experiments = records_of(campaign).size();
  if (experiments == 0) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  Table table(
      "What was wrong in each loop, and what the chain of the thesis says about it. Ivar, Ivar_{diag} and "
      "Ivar_{basis} are those of the CV with the fault.",
      {{"No."},
       {"Kind", Table::Align::left},
       {"Fault", Table::Align::text},
       {"True CV", Table::Align::left},
       {"Located", Table::Align::left},
       {"Source", Table::Align::left},
       {"Verdict", Table::Align::left},
       {"I_{MPM}"},
       {"Ivar"},
       {"Ivar_{diag}"},
       {"Ivar_{basis}"}});
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (record.draw.index >= input.listed_below)
      return;
    const AssessmentRecord& chain = record.chain();
    table.row({input.number_words(record.draw.index), kind_name(record.draw.kind),
               as_label(fault_text(study, record.draw)), as_label(cv_name(study, record.draw.true_cv())),
               chain.flagged ? as_label(cv_name(study, chain.predicted_cv)) : "-",
               chain.flagged ? source_name(chain.predicted_source) : "-", outcome_cell(study, record),
               fixed(chain.flagged ? chain.number("i_mpm") : kNaN),
               fixed(index_of(study, record, chain.values("ivar").reshaped())),
               fixed(index_of(study, record, chain.values("ivar_diag").reshaped())),
               fixed(index_of(study, record, record.ivar_basis))},
              experiment_anchor(input, record));
  });
  if (experiments > kMostExperiments)
    section.say(fmt::format("The first {} of {}; {} writes all.", kMostExperiments, experiments,
                            code(fmt::format("mpmbench export {} --table experiments", input.file))));
  section.add(std::move(table));
  return section;
}

}  // namespace mpm
