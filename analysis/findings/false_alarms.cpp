#include "analysis/findings/false_alarms.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

/// The experiments of one group.
struct AlarmCounts {
  FalseAlarms group;
  std::int64_t verdicts = 0, flagged = 0, mpm = 0, ud = 0;

  void add(const ExperimentRecord& record, const AssessmentRecord& said) {
    if (!group.has(record.draw))
      return;
    group.add(record);
    if (!said.answered())
      return;
    ++verdicts;
    if (!said.flagged)
      return;
    ++flagged;
    mpm += said.predicted_source == FaultSource::mpm ? 1 : 0;
    ud += said.predicted_source == FaultSource::ud ? 1 : 0;
  }

  FalseAlarms result(double confidence) const {
    FalseAlarms found = group;
    found.finish(confidence);
    found.false_alarm = rate(flagged, verdicts, confidence);
    found.false_mpm = rate(mpm, verdicts, confidence);
    found.false_ud = rate(ud, verdicts, confidence);
    return found;
  }
};

struct AllAlarmCounts {
  std::size_t method;
  double confidence;
  std::vector<AlarmCounts> groups = {};

  void add_group(ExperimentKind kind, std::optional<TuningParameter> parameter) {
    FalseAlarms group;
    group.kind = kind;
    group.parameter = parameter;
    groups.push_back({group});
  }
  void add(const ExperimentRecord& record) {
    for (AlarmCounts& group : groups)
      group.add(record, record.assessments[method]);
  }
  std::vector<FalseAlarms> result() const {
    std::vector<FalseAlarms> found;
    for (const AlarmCounts& group : groups)
      found.push_back(group.result(confidence));
    return found;
  }
};

std::string with_blanks(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace

std::string FalseAlarms::name() const {
  const std::string of_kind(to_string(kind));
  return parameter ? of_kind + "_" + std::string(to_string(*parameter)) : of_kind;
}

std::string FalseAlarms::label() const {
  return with_blanks(std::string(parameter ? to_string(*parameter) : to_string(kind)));
}

bool FalseAlarms::has(const ExperimentDraw& draw) const {
  return !draw.named && draw.kind == kind &&
         (!parameter || (draw.tuning && draw.tuning->parameter == *parameter));
}

Collector<std::vector<FalseAlarms>> false_alarm_collector(const Study& study, std::size_t method) {
  AllAlarmCounts counts{method, study.aggregate.confidence};
  if (study.experiments.healthy > 0)
    counts.add_group(ExperimentKind::healthy, std::nullopt);
  if (study.experiments.tuning == 0)
    return collector_of(std::move(counts));
  counts.add_group(ExperimentKind::tuning, std::nullopt);
  const std::array<double, 4> weights = study.tuning.weights_for(study.controller);
  for (std::size_t p = 0; p < weights.size(); ++p)
    if (weights[p] > 0.0)
      counts.add_group(ExperimentKind::tuning, kTuningParameters[p]);
  return collector_of(std::move(counts));
}

std::vector<Finding> rows_of(const FalseAlarms& group, const std::string& method) {
  std::vector<Finding> rows;
  const std::string of = with_blanks(group.name());
  const auto add = [&](const char* quantity, const char* label, const char* meaning, const Rate& share,
                       Prominence prominence = Prominence::table) {
    const Finding finding{.name = fmt::format("{}_{}", quantity, group.name()),
                          .label = fmt::format("{}, {}", label, of),
                          .meaning = meaning,
                          .group = FindingGroup::faultless,
                          .prominence = prominence,
                          .kind = group.kind,
                          .method = method};
    rows.push_back(finding.with(share));
  };
  if (!group.parameter)
    add("infeasible", "infeasible", "share of infeasible experiments", group.infeasible);
  add("false_alarm", "false alarm", "share of experiments with impact where model and plant agree",
      group.false_alarm, group.parameter ? Prominence::table : Prominence::headline);
  if (group.parameter)
    return rows;
  add("false_mpm", "false mpm", "share of experiments in which the false alarm is a mismatch",
      group.false_mpm);
  add("false_ud", "false ud", "share of experiments in which the false alarm is a disturbance",
      group.false_ud);
  return rows;
}

}  // namespace mpm
