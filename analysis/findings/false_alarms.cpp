#include "analysis/findings/false_alarms.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace mpm {
namespace {

FalseAlarms count_alarms(FalseAlarms group, std::size_t method, std::span<const ExperimentRecord> records,
                         double confidence) {
  std::int64_t verdicts = 0, flagged = 0, mpm = 0, ud = 0;
  for (const ExperimentRecord& record : records) {
    if (!group.has(record.draw))
      continue;
    group.add(record.status);
    const AssessmentRecord& said = record.assessments[method];
    if (!said.answered())
      continue;
    ++verdicts;
    if (!said.flagged)
      continue;
    ++flagged;
    mpm += said.predicted_source == FaultSource::mpm ? 1 : 0;
    ud += said.predicted_source == FaultSource::ud ? 1 : 0;
  }
  group.finish(confidence);
  group.false_alarm = rate(flagged, verdicts, confidence);
  group.false_mpm = rate(mpm, verdicts, confidence);
  group.false_ud = rate(ud, verdicts, confidence);
  return group;
}

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

std::vector<FalseAlarms> false_alarms(const Study& study, std::size_t method,
                                      std::span<const ExperimentRecord> records) {
  std::vector<FalseAlarms> groups;
  const auto add = [&](ExperimentKind kind, std::optional<TuningParameter> parameter) {
    FalseAlarms group;
    group.kind = kind;
    group.parameter = parameter;
    groups.push_back(count_alarms(group, method, records, study.aggregate.confidence));
  };
  if (study.experiments.healthy > 0)
    add(ExperimentKind::healthy, std::nullopt);
  if (study.experiments.tuning == 0)
    return groups;
  add(ExperimentKind::tuning, std::nullopt);
  const std::array<double, 4> weights = study.tuning.weights_for(study.controller);
  for (std::size_t p = 0; p < weights.size(); ++p)
    if (weights[p] > 0.0)
      add(ExperimentKind::tuning, kTuningParameters[p]);
  return groups;
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
