#include "analysis/findings/trial_findings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/statistics/conformal_threshold.hpp"
#include "analysis/statistics/quantile.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

bool has_answer(const ExperimentRecord& record, std::size_t method) {
  return record.status == ExperimentStatus::ok && record.assessments[method].answered();
}

/// Returns the threshold of each half. A single loop has no other half, so it is compared with its own
/// threshold.
std::array<double, 2> thresholds_of_halves(const std::vector<double>& scores) {
  std::array<std::vector<double>, 2> halves;
  for (std::size_t place = 0; place < scores.size(); ++place)
    halves[place % 2].push_back(scores[place]);
  return {trial_threshold(halves[0]), trial_threshold(halves[1].empty() ? halves[0] : halves[1])};
}

}  // namespace

double trial_threshold(const std::vector<double>& healthy, double false_alarms) {
  if (healthy.empty())
    return kNaN;
  if (const std::optional<double> conformal = conformal_threshold(healthy, false_alarms))
    return *conformal;
  const double median = upper_median(healthy), most = *std::max_element(healthy.begin(), healthy.end());
  double excess = 0.0, above = 0.0;
  for (const double score : healthy)
    if (score > median) {
      excess += score - median;
      above += 1.0;
    }
  const double beyond = -std::log((static_cast<double>(healthy.size()) + 1.0) * false_alarms);
  return above > 0.0 && std::isfinite(excess) ? most + excess / above * beyond : most;
}

TrialFindings trial_findings(const Study& trial, std::size_t method, const RecordRange& records,
                             const AssessmentRecord& said) {
  std::vector<double> scores;  // of healthy loops
  records.each([&](const ExperimentRecord& record) {
    if (has_answer(record, method) && record.draw.kind == ExperimentKind::healthy)
      scores.push_back(record.assessments[method].score);
  });
  TrialFindings found{.threshold = trial_threshold(scores), .of_half = thresholds_of_halves(scores)};
  const FaultSource named = named_source(said);
  std::int64_t same = 0, right = 0;
  const Collector<MethodRates> rates = rate_collector(trial, method);
  std::size_t healthy = 0;
  records.each([&](ExperimentRecord record) {
    AssessmentRecord& of_loop = record.assessments[method];
    const bool is_healthy = has_answer(record, method) && record.draw.kind == ExperimentKind::healthy;
    const double threshold = is_healthy ? found.threshold_for(healthy++) : found.threshold;
    if (of_loop.answered() && !std::isnan(threshold))
      of_loop.flagged = of_loop.score > threshold;
    rates.add(record);
    if (!has_answer(record, method) || !of_loop.flagged)
      return;
    if (named != FaultSource::none && named_source(of_loop) == named) {
      ++same;
      right += source_of(record.draw.kind) == named ? 1 : 0;
    }
  });
  const auto as_high =
      std::count_if(scores.begin(), scores.end(), [&said](double score) { return score >= said.score; });
  const double confidence = trial.aggregate.confidence;
  found.rates = rates.result();
  found.as_high = rate(as_high, std::ssize(scores), confidence);
  found.same_source = rate(right, same, confidence);
  return found;
}

}  // namespace mpm
