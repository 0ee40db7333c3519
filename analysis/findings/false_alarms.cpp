#include "analysis/findings/false_alarms.hpp"

namespace mpm {
namespace {

bool belongs_to(const ExperimentDraw& draw, const FalseAlarms& group) {
  return !draw.named && draw.kind == group.kind &&
         (!group.parameter || (draw.tuning && draw.tuning->parameter == *group.parameter));
}

FalseAlarms counted(FalseAlarms group, std::span<const ExperimentRecord> records, double confidence) {
  std::int64_t infeasible = 0, feasible = 0, mpm = 0, ud = 0;
  for (const ExperimentRecord& record : records) {
    if (!belongs_to(record.draw, group))
      continue;
    ++group.experiments;
    group.failed += record.status == ExperimentStatus::failed ? 1 : 0;
    infeasible += record.status == ExperimentStatus::infeasible ? 1 : 0;
    if (record.status != ExperimentStatus::ok)
      continue;
    ++feasible;
    if (record.diagnosis.impactful)
      ++(record.diagnosis.predicted_source == ExperimentKind::mpm ? mpm : ud);
  }
  group.infeasible = rate(infeasible, infeasible + feasible, confidence);
  group.false_alarm = rate(mpm + ud, feasible, confidence);
  group.false_mpm = rate(mpm, feasible, confidence);
  group.false_ud = rate(ud, feasible, confidence);
  return group;
}

}  // namespace

std::string FalseAlarms::name() const {
  const std::string of_kind(count_name(kind));
  return parameter ? of_kind + "_" + std::string(to_string(*parameter)) : of_kind;
}

std::string_view count_name(ExperimentKind kind) {
  return kind == ExperimentKind::none ? "healthy" : to_string(kind);
}

std::vector<FalseAlarms> false_alarms(const Study& study, std::span<const ExperimentRecord> records) {
  std::vector<FalseAlarms> groups;
  const auto add = [&](ExperimentKind kind, std::optional<TuningParameter> parameter) {
    FalseAlarms group;
    group.kind = kind;
    group.parameter = parameter;
    groups.push_back(counted(group, records, study.aggregate.confidence));
  };
  if (study.experiments.healthy > 0)
    add(ExperimentKind::none, std::nullopt);
  if (study.experiments.tuning == 0)
    return groups;
  add(ExperimentKind::tuning, std::nullopt);
  const std::array<double, 4> weights = study.tuning.weights_for(study.controller);
  for (std::size_t p = 0; p < weights.size(); ++p)
    if (weights[p] > 0.0)
      add(ExperimentKind::tuning, kTuningParameters[p]);
  return groups;
}

}  // namespace mpm
