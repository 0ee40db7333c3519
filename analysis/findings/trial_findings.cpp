#include "analysis/findings/trial_findings.hpp"

#include "analysis/experiment/judgement.hpp"

namespace mpm {

TrialFindings trial_findings(const Study& trial, std::size_t method, const RecordRange& records,
                             const AssessmentRecord& said) {
  const FaultSource named = named_source(said);
  std::int64_t healthy = 0, as_high = 0, same = 0, right = 0;
  const Collector<MethodRates> rates = rate_collector(trial, method);
  records.each([&](const ExperimentRecord& record) {
    rates.add(record);
    const AssessmentRecord& of_loop = record.assessments[method];
    if (record.status != ExperimentStatus::ok || !of_loop.answered())
      return;
    if (record.draw.kind == ExperimentKind::healthy) {
      ++healthy;
      as_high += of_loop.score >= said.score ? 1 : 0;
    }
    if (named != FaultSource::none && named_source(of_loop) == named) {
      ++same;
      right += source_of(record.draw.kind) == named ? 1 : 0;
    }
  });
  const double confidence = trial.aggregate.confidence;
  return {rates.result(), rate(as_high, healthy, confidence), rate(right, same, confidence)};
}

}  // namespace mpm
