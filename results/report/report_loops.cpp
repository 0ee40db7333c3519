#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/report/report.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kWrongLoops = 6;  // they add a few hundred kilobytes to the page

/// Returns the effect of the fault on its CV, as a distance from 1: twice the variance counts as much as half
/// of it.
double cost(const ExperimentRecord& record) {
  const Eigen::Index cv = record.draw.true_cv();
  return cv >= 0 && cv < record.ivar_basis.size() ? std::abs(std::log(record.ivar_basis(cv))) : 0.0;
}

/// An experiment that may be shown.
struct Candidate {
  double cost;
  std::int64_t index;
};

/// The experiments that may be shown for each reason, in the order of the archive.
struct Candidates {
  std::vector<Candidate> faulty, healthy, wrong;

  explicit Candidates(const Campaign& campaign) {
    records_of(campaign).each([&](const ExperimentRecord& record) {
      const AssessmentRecord* const chain = record.diagnosed();
      if (chain == nullptr || !chain->answered())
        return;
      const Candidate candidate{cost(record), record.draw.index};
      const ExperimentKind kind = record.draw.kind;
      if (judge(campaign.study, record, *chain).wrong())
        wrong.push_back(candidate);
      else if (chain->flagged && (kind == ExperimentKind::mpm || kind == ExperimentKind::ud))
        faulty.push_back(candidate);
      else if (!chain->flagged && kind == ExperimentKind::healthy)
        healthy.push_back(candidate);
    });
  }
};

/// Returns the candidate with the median cost, which is neither the clearest nor the faintest.
std::vector<Candidate> middle_one(std::vector<Candidate> of) {
  std::stable_sort(of.begin(), of.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return of.empty() ? of : std::vector{of[of.size() / 2]};
}

std::vector<Candidate> costliest(std::vector<Candidate> of) {
  std::stable_sort(of.begin(), of.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost > b.cost; });
  of.resize(std::min(of.size(), kWrongLoops));
  return of;
}

/// Keeps the panels of the CVs that a verdict is about, and of the MV of a mismatched channel. The others
/// would only fill the page.
void keep_panels(Figure& figure, const Study& study, const ExperimentRecord& record) {
  const AssessmentRecord* const chain = record.diagnosed();
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
    return as_label(said.reason.empty() ? "no verdict" : said.reason);
  if (!said.flagged)
    return "nothing wrong";
  return fmt::format("{}: {}", as_label(cv_name(study, said.predicted_cv)),
                     source_name(said.predicted_source));
}

Cell judged(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  if (!said.answered())
    return "-";
  if (!said.flagged && has_impact(study.diagnosis, record))
    return Cell("missed").toned(Cell::Tone::bad);
  return judge(study, record, said).wrong() ? Cell("wrong").toned(Cell::Tone::bad)
                                            : Cell("right").toned(Cell::Tone::good);
}

Table said_table(const Study& study, const ExperimentRecord& record) {
  Table table("What was said about it.", {{"Method", Table::Align::left},
                                          {"CV and source", Table::Align::left},
                                          {"That is", Table::Align::left}});
  for (const AssessmentRecord& said : record.assessments)
    table.row({as_label(said.form->method().name), verdict_of(study, said), judged(study, record, said)});
  return table;
}

void add_loop(Section& section, const ReportInput& input, const LoopView& view, bool whole) {
  const Study& study = input.campaign.study;
  const ExperimentRecord& record = view.of.record;
  section.add(fmt::format("<div class=\"loop\" id=\"loop-{}\">\n<h3>{}</h3>\n", record.draw.index,
                          html_text(experiment_title(study, record.draw))));
  section.add(said_table(study, record));
  Figure figure =
      trajectory_figure(study, view.trajectory, view.nominal, fmt::format("loop-{}", record.draw.index));
  if (!whole)
    keep_panels(figure, study, record);
  section.add(std::move(figure));
  section.add("</div>\n");
}

std::string loops_answer(const ReportInput& input, const ExperimentRecord& faulty) {
  const Study& study = input.campaign.study;
  const Eigen::Index cv = faulty.draw.true_cv();
  const Eigen::MatrixXd ivar = faulty.chain().values("ivar");
  if (cv < 0 || cv >= ivar.size())
    return "";
  return fmt::format(
      "With the fault, {} varies {:.2f} times as much as its nominal output y_{{0}}: this is Ivar. In the "
      "basis case, where nothing is wrong, it is {:.2f} times.",
      as_label(cv_name(study, cv)), ivar(cv), input.campaign.basis.diagnosis.ivar(cv));
}

}  // namespace

std::vector<ShownExperiment> loops_to_show(const Campaign& campaign) {
  if (campaign.study.names_scenarios() || chain_place(campaign) == campaign.methods.size())
    return {};
  std::vector<ShownExperiment> shown;
  std::map<std::int64_t, std::size_t> places;
  const auto show = [&](LoopReason reason, const std::vector<Candidate>& chosen) {
    for (const Candidate& candidate : chosen) {
      places[candidate.index] = shown.size();
      shown.push_back({reason, {}});
    }
  };
  const Candidates candidates(campaign);
  show(LoopReason::faulty, middle_one(candidates.faulty));
  show(LoopReason::healthy, middle_one(candidates.healthy));
  show(LoopReason::wrong, costliest(candidates.wrong));
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (const auto place = places.find(record.draw.index); place != places.end())
      shown[place->second].record = record;
  });
  return shown;
}

std::vector<const LoopView*> ReportInput::loops_of(LoopReason reason) const {
  std::vector<const LoopView*> views;
  for (const LoopView& view : loops)
    if (view.of.reason == reason)
      views.push_back(&view);
  return views;
}

std::string ReportInput::number_words(std::int64_t index) const {
  const bool shown = std::any_of(loops.begin(), loops.end(), [index](const LoopView& view) {
    return view.of.record.draw.index == index;
  });
  return shown ? link(fmt::format("loop-{}", index), fmt::to_string(index)) : fmt::to_string(index);
}

Section loops_section(const ReportInput& input) {
  Section section{"loops", "What does a faulty loop look like, and a healthy one?", {}};
  const std::vector<const LoopView*> faulty = input.loops_of(LoopReason::faulty);
  const std::vector<const LoopView*> healthy = input.loops_of(LoopReason::healthy);
  if (faulty.empty() && healthy.empty()) {
    section.leave_out("no loop with a right verdict was stored.");
    return section;
  }
  for (const LoopView* view : faulty) {
    section.answer = loops_answer(input, view->of.record);
    add_loop(section, input, *view, true);
  }
  for (const LoopView* view : healthy)
    add_loop(section, input, *view, true);
  if (healthy.empty())
    section.say("No experiment of this study is healthy; the " + link("basis", "basis case") +
                " is the same loop without any fault.");
  return section;
}

void add_wrong_loops(Section& section, const ReportInput& input) {
  for (const LoopView* view : input.loops_of(LoopReason::wrong))
    add_loop(section, input, *view, false);
}

}  // namespace mpm
