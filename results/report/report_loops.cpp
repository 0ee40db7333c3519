#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kWrongLoops = 6;  // a page of a few hundred kilobytes more

const ExperimentRecord* record_of(const Campaign& campaign, std::int64_t index) {
  const auto found =
      std::find_if(campaign.records.begin(), campaign.records.end(),
                   [index](const ExperimentRecord& record) { return record.draw.index == index; });
  return found == campaign.records.end() ? nullptr : &*found;
}

bool is_wrong(const Campaign& campaign, const ExperimentRecord& record) {
  const AssessmentRecord* const chain = record.by(kChainMethod);
  return chain != nullptr && chain->answered() && judge(campaign.study, record, *chain).wrong();
}

/// What the fault does to the CV that it is on, as a distance from 1: of twice the variance as of half of it.
double cost(const ExperimentRecord& record) {
  const Eigen::Index cv = record.draw.true_cv();
  return cv >= 0 && cv < record.ivar_basis.size() ? std::abs(std::log(record.ivar_basis(cv))) : 0.0;
}

/// Of these, sorted by what they cost, the one in the middle: neither the clearest nor the faintest.
std::vector<std::int64_t> middle_one(std::vector<const ExperimentRecord*> records) {
  if (records.empty())
    return {};
  std::stable_sort(records.begin(), records.end(),
                   [](const ExperimentRecord* a, const ExperimentRecord* b) { return cost(*a) < cost(*b); });
  return {records[records.size() / 2]->draw.index};
}

std::vector<std::int64_t> typical(const Campaign& campaign, bool with_fault) {
  std::vector<const ExperimentRecord*> records;
  for (const ExperimentRecord& record : campaign.records) {
    const AssessmentRecord* const chain = record.by(kChainMethod);
    const bool one_fault = record.draw.kind == ExperimentKind::mpm || record.draw.kind == ExperimentKind::ud;
    if (chain != nullptr && chain->answered() && !is_wrong(campaign, record) &&
        chain->flagged == with_fault &&
        (with_fault ? one_fault : record.draw.kind == ExperimentKind::healthy))
      records.push_back(&record);
  }
  return middle_one(std::move(records));
}

std::vector<std::int64_t> costliest_wrong(const Campaign& campaign) {
  std::vector<const ExperimentRecord*> wrong;
  for (const ExperimentRecord& record : campaign.records)
    if (is_wrong(campaign, record))
      wrong.push_back(&record);
  std::stable_sort(wrong.begin(), wrong.end(),
                   [](const ExperimentRecord* a, const ExperimentRecord* b) { return cost(*a) > cost(*b); });
  wrong.resize(std::min(wrong.size(), kWrongLoops));
  std::vector<std::int64_t> indices;
  for (const ExperimentRecord* record : wrong)
    indices.push_back(record->draw.index);
  return indices;
}

/// The CVs that a verdict is about, and the MV of a mismatched channel; the others would only fill the page.
void keep_panels(Figure& figure, const Study& study, const ExperimentRecord& record) {
  const AssessmentRecord* const chain = record.by(kChainMethod);
  std::vector<Eigen::Index> kept{record.draw.true_cv(), chain == nullptr ? -1 : chain->predicted_cv};
  for (const Mismatch& mismatch : record.draw.mismatches)
    kept.push_back(study.cv_count() + mismatch.input);
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    if (std::find(kept.begin(), kept.end(), static_cast<Eigen::Index>(i)) != kept.end())
      panels.push_back(std::move(figure.panels[i]));
  if (!panels.empty())
    figure.panels = std::move(panels);
}

std::string verdict_of(const Study& study, const AssessmentRecord& said) {
  if (!said.answered())
    return html_text(said.reason.empty() ? "no verdict" : said.reason);
  if (!said.flagged)
    return "nothing wrong";
  return fmt::format("{}: {}", html_text(cv_name(study, said.predicted_cv)),
                     source_name(said.predicted_source));
}

std::string judged(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  if (!said.answered())
    return html_number(NAN);
  const bool missed = !said.flagged && has_impact(study.diagnosis, record);
  if (missed)
    return "<span class=\"no\">missed</span>";
  return judge(study, record, said).wrong() ? "<span class=\"no\">wrong</span>"
                                            : "<span class=\"yes\">right</span>";
}

std::string said_table(const Study& study, const ExperimentRecord& record) {
  HtmlTable table("What was said of it.", {{"Method", HtmlTable::Align::left},
                                           {"CV and source", HtmlTable::Align::left},
                                           {"That is", HtmlTable::Align::left}});
  for (const AssessmentRecord& said : record.assessments)
    table.row({html_text(said.form->method().name), verdict_of(study, said), judged(study, record, said)});
  return table.html();
}

void add_loop(ReportSection& section, const ReportInput& input, const LoopView& view, bool whole) {
  const Study& study = input.campaign.study;
  const ExperimentRecord& record = *record_of(input.campaign, view.index);
  section.add(fmt::format("<div class=\"loop\" id=\"loop-{}\">\n<h3>{}</h3>\n", view.index,
                          html_text(experiment_title(study, record.draw))));
  section.add(said_table(study, record));
  Figure figure = trajectory_figure(study, view.trajectory, view.nominal, fmt::format("loop-{}", view.index));
  if (!whole)
    keep_panels(figure, study, record);
  section.add(std::move(figure));
  section.add("</div>\n");
}

const LoopView* view_of(const ReportInput& input, const std::vector<std::int64_t>& indices) {
  for (const LoopView& view : input.loops)
    if (!indices.empty() && view.index == indices.front())
      return &view;
  return nullptr;
}

std::string loops_answer(const ReportInput& input, const ExperimentRecord& faulty) {
  const Study& study = input.campaign.study;
  const Eigen::Index cv = faulty.draw.true_cv();
  const Eigen::VectorXd ivar = faulty.chain().ivar;
  if (cv < 0 || cv >= ivar.size())
    return "";
  return fmt::format(
      "With the fault {} varies {:.2f} times as much as its nominal output y<sub>0</sub>, which is what "
      "Ivar says; in the basis case, where nothing is wrong, {:.2f} times.",
      html_text(cv_name(study, cv)), ivar(cv), input.campaign.basis.diagnosis.ivar(cv));
}

}  // namespace

std::vector<std::int64_t> loops_to_show(const Campaign& campaign) {
  std::vector<std::int64_t> indices;
  if (campaign.study.names_scenarios() || chain_place(campaign) == campaign.methods.size())
    return indices;
  for (const auto& chosen : {typical(campaign, true), typical(campaign, false), costliest_wrong(campaign)})
    indices.insert(indices.end(), chosen.begin(), chosen.end());
  return indices;
}

bool ReportInput::shows_loop(std::int64_t index) const {
  return std::any_of(loops.begin(), loops.end(),
                     [index](const LoopView& view) { return view.index == index; });
}

ReportSection loops_section(const ReportInput& input) {
  ReportSection section{"loops", "What does a faulty loop look like, and a healthy one?", {}};
  const LoopView* const faulty = view_of(input, typical(input.campaign, true));
  const LoopView* const healthy = view_of(input, typical(input.campaign, false));
  if (faulty == nullptr && healthy == nullptr) {
    section.leave_out("no loop with a right verdict is at hand.");
    return section;
  }
  if (faulty != nullptr) {
    section.answer = loops_answer(input, *record_of(input.campaign, faulty->index));
    add_loop(section, input, *faulty, true);
  }
  if (healthy != nullptr)
    add_loop(section, input, *healthy, true);
  else
    section.add(
        "<p>No experiment of this study is healthy; the <a href=\"#basis\">basis case</a> is the same loop "
        "without any fault.</p>\n");
  return section;
}

void add_wrong_loops(ReportSection& section, const ReportInput& input) {
  for (const std::int64_t index : costliest_wrong(input.campaign))
    if (const LoopView* const view = view_of(input, {index}))
      add_loop(section, input, *view, false);
}

}  // namespace mpm
