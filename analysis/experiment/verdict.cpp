#include "analysis/experiment/verdict.hpp"

#include "analysis/experiment/scenario_verdict.hpp"

namespace mpm {
namespace {

Verdict verdict(bool right) {
  return right ? Verdict::right : Verdict::wrong;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::wrong:
      return "wrong";
    case Verdict::right:
      return "right";
  }
  return "unknown";
}

Verdict location_verdict(const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return Verdict::none;
  if (record.draw.named)
    return verdict(scenario_verdict(record).located());
  if (!record.diagnosis.impactful || is_faultless(record.draw.kind))
    return Verdict::none;
  return verdict(record.diagnosis.predicted_cv == record.draw.true_cv());
}

bool in_source_population(const Study& study, const ExperimentRecord& record) {
  return record.status == ExperimentStatus::ok &&
         (record.diagnosis.impactful || study.diagnosis.source_population == SourcePopulation::feasible);
}

Verdict source_verdict(const Study& study, const ExperimentRecord& record) {
  if (record.draw.named) {
    const ScenarioVerdict of_cvs = scenario_verdict(record);
    return of_cvs.judged_source ? verdict(of_cvs.wrong_source.empty()) : Verdict::none;
  }
  const bool single_fault = record.draw.kind == ExperimentKind::mpm || record.draw.kind == ExperimentKind::ud;
  if (!single_fault || !in_source_population(study, record))
    return Verdict::none;
  return verdict(record.diagnosis.predicted_source == record.draw.kind);
}

}  // namespace mpm
