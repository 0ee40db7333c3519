#include "analysis/records/verdict_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/methods/ours/source_weights.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/statistics/standstill.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {
namespace {

bool has_verdict(const ExperimentRecord& record, std::size_t method) {
  return record.status == ExperimentStatus::ok && record.assessments[method].answered();
}

bool is_without_fault(const ExperimentRecord& record) {
  return record.draw.kind == ExperimentKind::healthy;
}

/// Calls `see` with each record that has an answer in the place `method`, and whether its score is above its
/// threshold.
template <class See>
void each_beside_threshold(const RecordRange& records, std::size_t method, const TrialFindings& found,
                           See see) {
  std::size_t place = 0;  // among the records without a fault
  records.each([&](const ExperimentRecord& record) {
    if (!has_verdict(record, method))
      return;
    const double threshold = is_without_fault(record) ? found.threshold_for(place++) : found.threshold;
    see(record, record.assessments[method].score > threshold);
  });
}

}  // namespace

Eigen::VectorXd number_thresholds(const RecordRange& records, std::size_t method, const std::string& number,
                                  Eigen::Index rows) {
  std::vector<std::vector<double>> scores(static_cast<std::size_t>(rows));
  records.each([&](const ExperimentRecord& record) {
    if (!has_verdict(record, method) || !is_without_fault(record))
      return;
    for (Eigen::Index row = 0; row < rows; ++row)
      if (const double score = record.assessments[method].number(number, row); !std::isnan(score))
        scores[static_cast<std::size_t>(row)].push_back(score);
  });
  Eigen::VectorXd thresholds(rows);
  for (Eigen::Index row = 0; row < rows; ++row)
    thresholds(row) =
        trial_threshold(scores[static_cast<std::size_t>(row)], kTrialFalseAlarms / static_cast<double>(rows));
  return thresholds;
}

TrialCounts trial_counts(const RecordRange& records, std::size_t method, const TrialFindings& found,
                         RecordSource named) {
  TrialCounts counts;
  each_beside_threshold(records, method, found, [&](const ExperimentRecord& record, bool is_above) {
    const std::int64_t healthy = is_without_fault(record) ? 1 : 0;
    ++(is_above ? counts.above : counts.below);
    (is_above ? counts.healthy_above : counts.healthy_below) += healthy;
    if (!is_above || named == RecordSource::unknown || !has_verdict(record, 0))
      return;
    const FaultSource said = record.assessments.front().predicted_source;
    if (said == FaultSource::none || record_source(said, ToldSource::valve) != named)
      return;
    ++counts.same;
    counts.right += record_source(source_of(record.draw.kind), ToldSource::valve) == named ? 1 : 0;
  });
  return counts;
}

std::vector<std::int64_t> unexplained_records(const RecordRange& records, std::size_t method,
                                              const TrialFindings& found) {
  std::vector<std::int64_t> indices;
  each_beside_threshold(records, method, found, [&](const ExperimentRecord& record, bool is_above) {
    if (is_above)
      indices.push_back(record.draw.index);
  });
  return indices;
}

double fit_threshold(const RecordRange& records, std::size_t method) {
  std::vector<double> fits;
  records.each([&](const ExperimentRecord& record) {
    if (has_verdict(record, method) &&
        (is_without_fault(record) ||
         record_source(source_of(record.draw.kind), ToldSource::valve) == RecordSource::disturbance))
      fits.push_back(record.assessments[method].number(kFitNumber));
  });
  return trial_threshold(fits);
}

void take_sources(const AssessedLoop& loop, const AssessmentRecord& mpmbench, double most_fit,
                  VerdictEvidence& evidence) {
  SourceWeights weights = stated_weights(mpmbench);
  const std::optional<FaultLikelihoods> found = stated_likeliest(mpmbench);
  if (found) {
    if (found->sensor_stuck)
      evidence.stuck = longest_standstill(loop.y.row(found->sensor_cv));
    else
      weights = with_none_of_these(weights, mpmbench.number("dependence") / std::fmax(most_fit, 1.0));
    evidence.jumps = found->sensor_jumps;
    evidence.likeliest = found->named;
    evidence.md = found->md;
    evidence.valve_mv = found->valve_mv;
    evidence.sensor_cv = found->sensor_cv;
    if (found->data_cv >= 0)
      evidence.late_cvs = {found->data_cv};
    evidence.late = found->late;
  } else if (const double valve = mpmbench.number("valve_mv"); !std::isnan(valve)) {
    evidence.valve_mv = static_cast<Eigen::Index>(valve);
  }
  evidence.weights = weights;
}

}  // namespace mpm
