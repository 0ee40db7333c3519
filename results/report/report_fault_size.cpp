#include <cstdint>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "analysis/findings/fault_size.hpp"
#include "results/archive/variable_text.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_heading.hpp"

namespace mpm {
namespace {

constexpr int kBins = 6;

const Pen kSeen{colour::kSky, Dash::solid, Mark::circle, 5.0, 0.7};
const Pen kDiagnosed{colour::kBlue, Dash::solid, Mark::dot, 1.6, 0.55};
const Pen kMissed{colour::kGrey, Dash::none, Mark::circle, 1.0, 0.35};
const Pen kWrongVerdict{colour::kVermillion, Dash::none, Mark::triangle, 1.0, 0.5};
const Pen kNoFault{colour::kGrey, Dash::dashed, Mark::none, 1.2};

/// The title and the axis label of the panel of a measure.
struct Labels {
  std::string title, axis;
};

Labels labels(FaultSize size, const Study& study) {
  switch (size) {
    case FaultSize::gain_factor:
      return {"MPM in a gain", "factor of the gain (-)"};
    case FaultSize::time_constant_factor:
      return {"MPM in a time constant", "factor of the time constant (-)"};
    case FaultSize::dead_time_shift:
      return {"MPM in a dead time",
              "shift of the dead time (" + as_label(unit_text(study.plant.time_unit)) + ")"};
    case FaultSize::disturbance_deviation:
      return {"UD", "standard deviation of the disturbance (CV unit)"};
  }
  return {};
}

std::vector<Whisker> whiskers(const std::vector<SizeBin>& bins, Rate SizeBin::*rate, const char* what) {
  std::vector<Whisker> list;
  for (const SizeBin& bin : bins) {
    const Rate& share = bin.*rate;
    list.push_back({bin.median, 100.0 * share.value, 100.0 * share.interval.lower,
                    100.0 * share.interval.upper,
                    fmt::format("{:.3g} to {:.3g}: {} of {} {}", bin.smallest, bin.largest, share.hits,
                                share.total, what)});
  }
  return list;
}

void add_curve(PanelScript& panel, const std::vector<Whisker>& list, const Pen& pen) {
  std::vector<double> x, y;
  for (const Whisker& whisker : list) {
    x.push_back(whisker.at);
    y.push_back(whisker.value);
  }
  Pen thin = pen;
  thin.width = 1.0;
  panel.line(x, y, thin);
  panel.upright_whiskers(list, pen);
}

/// Makes a mark for each fault that was not diagnosed correctly; the marks are in rows below the shares.
std::map<std::int64_t, NamedPoint> fault_marks(const ReportInput& input,
                                               const std::vector<SizedFault>& faults) {
  constexpr double kMissedRow = -7, kWrongRow = -15;
  std::map<std::int64_t, NamedPoint> marks;
  for (const SizedFault& fault : faults)
    if (!fault.diagnosed)
      marks[fault.experiment] = {fault.size, fault.flagged ? kWrongRow : kMissedRow, ""};
  records_of(input.campaign).each([&](const ExperimentRecord& record) {
    if (const auto mark = marks.find(record.draw.index); mark != marks.end()) {
      mark->second.name = experiment_line(input.campaign.study, record);
      mark->second.anchor = experiment_anchor(input, record);
    }
  });
  return marks;
}

Panel size_panel(const ReportInput& input, FaultSize size, const std::vector<SizedFault>& faults) {
  const Study& study = input.campaign.study;
  const std::vector<SizeBin> bins = size_bins(faults, kBins, study.aggregate.confidence);
  std::map<std::int64_t, NamedPoint> marks = fault_marks(input, faults);
  std::vector<NamedPoint> missed, wrong;
  for (const SizedFault& fault : faults)
    if (!fault.diagnosed)
      (fault.flagged ? wrong : missed).push_back(std::move(marks[fault.experiment]));
  const Labels text = labels(size, study);
  PanelScript panel(std::string(to_string(size)),
                    fmt::format("{}: {} experiments", text.title, faults.size()), {.label = text.axis},
                    {.label = "share (%)", .lower = -20, .upper = 102, .ticks = {0, 20, 40, 60, 80, 100}});
  if (size == FaultSize::dead_time_shift)
    panel.upright(0.0, kNoFault);
  else if (size != FaultSize::disturbance_deviation)
    panel.upright(1.0, kNoFault);
  add_curve(panel, whiskers(bins, &SizeBin::flagged, "have an impact"), kSeen);
  add_curve(panel, whiskers(bins, &SizeBin::diagnosed, "are diagnosed correctly"), kDiagnosed);
  panel.points(missed, kMissed);
  panel.points(wrong, kWrongVerdict);
  return panel.finish(
      fmt::format("Share of faults with impact and share diagnosed correctly against the size of "
                  "the fault: {}.",
                  text.title));
}

}  // namespace

Section fault_size_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  Section section{"fault-size", "Which small faults are missed?", {}};
  Figure figure;
  figure.name = "fault-size";
  figure.caption = fmt::format(
      "Share of the feasible experiments with a single fault that have an impact, and share in which CV and "
      "source are right as well, against the size of the fault: {} groups of equal size at their medians, "
      "{:g} % intervals. Below them, one mark for each experiment without impact and for each wrong verdict.",
      kBins, 100.0 * study.aggregate.confidence);
  figure.legend = {{"has an impact", kSeen},
                   {"CV and source right", kDiagnosed},
                   {"without impact", kMissed},
                   {"wrong verdict", kWrongVerdict},
                   {"no fault", kNoFault}};
  std::vector<SizedFault> all;
  for (const FaultSize size : {FaultSize::gain_factor, FaultSize::time_constant_factor,
                               FaultSize::dead_time_shift, FaultSize::disturbance_deviation}) {
    const std::vector<SizedFault> faults =
        faults_by_size(study, chain_place(input.campaign), records_of(input.campaign), size);
    if (!faults.empty())
      figure.panels.push_back(size_panel(input, size, faults));
    all.insert(all.end(), faults.begin(), faults.end());
  }
  section.answer = fault_size_answer(all, study.aggregate.confidence);
  if (figure.panels.empty())
    section.leave_out("there is no feasible experiment with a single fault.");
  else
    section.add(std::move(figure));
  return section;
}

}  // namespace mpm
