#include "analysis/records/verdict_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/records/model_check.hpp"
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

/// A valve, where it is not said to be a sensor.
RecordSource record_source(FaultSource source, ToldSource told = ToldSource::valve) {
  switch (source) {
    case FaultSource::mpm:
      return RecordSource::mismatch;
    case FaultSource::ud:
      return RecordSource::disturbance;
    case FaultSource::mpm_ud:
      return RecordSource::both;
    case FaultSource::other:
      return told == ToldSource::sensor  ? RecordSource::sensor
             : told == ToldSource::valve ? RecordSource::valve
                                         : RecordSource::unknown;
    case FaultSource::none:
      break;
  }
  return RecordSource::unknown;
}

/// The most probable source of a CV; none without an answer.
FaultSource source_in(const AssessmentRecord& likelihood, Eigen::Index cv) {
  FaultSource best = FaultSource::none;
  double most = 0.0;
  if (cv >= 0)
    for (const auto& [name, source] :
         {std::pair{"cv_p_mpm", FaultSource::mpm}, std::pair{"cv_p_ud", FaultSource::ud},
          std::pair{"cv_p_both", FaultSource::mpm_ud}, std::pair{"cv_p_other", FaultSource::other}})
      if (const double share = likelihood.number(name, cv); share > most) {
        most = share;
        best = source;
      }
  return best;
}

/// Calls `see` with each record that has an answer in the place `method`, and whether its score is above its
/// threshold.
template <class See>
void each_beside_threshold(const RecordRange& records, std::size_t method, const TrialFindings& found,
                           See see) {
  std::size_t place = 0;  // among those without a fault
  records.each([&](const ExperimentRecord& record) {
    if (!has_verdict(record, method))
      return;
    const double threshold = is_without_fault(record) ? found.threshold_for(place++) : found.threshold;
    see(record, record.assessments[method].score > threshold);
  });
}

/// The posterior of `likelihood` as its list of faults has it, from that of each CV: the CVs are independent
/// of each other. The probabilities that it states of the loop are those of the loops of the suites, where a
/// mismatch beside a disturbance is rare. In a plant it is not.
OfSources posterior_of(const AssessmentRecord& likelihood) {
  double healthy = 1.0, neither = 1.0, no_mismatch = 1.0, no_disturbance = 1.0;
  for (Eigen::Index cv = 0; cv < likelihood.form->find("cv_p_mpm")->rows; ++cv) {
    const double mpm = likelihood.number("cv_p_mpm", cv), ud = likelihood.number("cv_p_ud", cv),
                 other = likelihood.number("cv_p_other", cv);
    const double none = std::max(0.0, 1.0 - mpm - ud - other - likelihood.number("cv_p_both", cv));
    healthy *= none;
    neither *= none + other;
    no_mismatch *= none + other + ud;
    no_disturbance *= none + other + mpm;
  }
  OfSources weights;
  weights[RecordSource::mismatch] = no_disturbance - neither;
  weights[RecordSource::disturbance] = no_mismatch - neither;
  weights[RecordSource::both] = std::max(0.0, 1.0 - no_disturbance - no_mismatch + neither);
  const double other = likelihood.number("p_other");
  const double of_sensors = other > 0.0 ? likelihood.number("p_sensor") / other : 0.0;
  weights[RecordSource::sensor] = (neither - healthy) * of_sensors;
  weights[RecordSource::valve] = (neither - healthy) * (1.0 - of_sensors);
  return weights;
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
    if (said == FaultSource::none || record_source(said) != named)
      return;
    ++counts.same;
    counts.right += record_source(source_of(record.draw.kind)) == named ? 1 : 0;
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

OfSources source_weights(const AssessmentRecord& likelihood, const AssessmentRecord& said) {
  OfSources weights = likelihood.answered() ? posterior_of(likelihood) : OfSources{};
  if (!said.answered() || !said.flagged)
    return weights;
  if (said.predicted_source == FaultSource::none) {
    double& mismatch = weights[RecordSource::mismatch];
    double& disturbance = weights[RecordSource::disturbance];
    if (said.form->method().tells_sources)
      mismatch = disturbance = 0.5 * (mismatch + disturbance);
    return weights;
  }
  const RecordSource named = record_source(said.predicted_source, said.told());
  if (record_source(source_in(likelihood, said.predicted_cv)) == named)
    return weights;
  const auto best = std::max_element(weights.each.begin(), weights.each.end());
  if (*best > 0.0)
    std::swap(weights[named], *best);
  else
    weights[named] = 1.0;
  return weights;
}

double fit_threshold(const RecordRange& records, std::size_t method) {
  std::vector<double> fits;
  records.each([&](const ExperimentRecord& record) {
    if (has_verdict(record, method) &&
        (is_without_fault(record) || record_source(source_of(record.draw.kind)) == RecordSource::disturbance))
      fits.push_back(record.assessments[method].number(kFitNumber));
  });
  return trial_threshold(fits);
}

SourceWeights with_alternatives(const OfSources& weights, const RecordAlternatives& alternatives,
                                double most_fit) {
  constexpr double kPrior = 0.1;
  // A source that the likelihood rules out keeps this probability: it takes the noise for an autoregression
  // of order 1 that never changes. Chosen on the records under the seeds 83 and 84
  // (tests/reliability/records.py).
  constexpr double kDoubt = 0.01;
  SourceWeights found;
  OfSources& all = found.of;
  const double most = std::max({alternatives.mismatch, alternatives.disturbance, alternatives.valve,
                                alternatives.sensor, alternatives.data});
  const auto share = [most](double likelihood) { return std::exp(likelihood - most); };
  const double mismatch = weights[RecordSource::mismatch], both = weights[RecordSource::both],
               disturbance = weights[RecordSource::disturbance], unknown = weights[RecordSource::unknown],
               sum = std::max(mismatch + both + disturbance + unknown, 1e-300),
               wrong_model = std::max((mismatch + both) / sum, kDoubt) * share(alternatives.mismatch),
               // The methods know of no mismatch of an MD, and see a disturbance in it.
      alone = alternatives.md < 0 && mismatch + both > 0.0 ? mismatch / (mismatch + both) : 1.0;
  all[RecordSource::mismatch] = alone * wrong_model;
  all[RecordSource::both] = (1.0 - alone) * wrong_model;
  all[RecordSource::disturbance] = std::max(disturbance / sum, kDoubt) * share(alternatives.disturbance);
  all[RecordSource::unknown] =
      unknown / sum * share(std::max(alternatives.mismatch, alternatives.disturbance));
  all[RecordSource::valve] = kPrior * share(alternatives.valve);
  all[RecordSource::sensor] = 2.0 * kPrior * share(alternatives.sensor);  // its two causes, until below
  all[RecordSource::data] = kPrior * share(alternatives.data);
  const auto best =
      static_cast<std::size_t>(std::max_element(all.each.begin(), all.each.end()) - all.each.begin());
  const double excess = alternatives.fit.each[best] / std::fmax(most_fit, 1.0);
  if (excess > 1.0) {
    const double kept = all.each[best] / (excess * excess);
    all[RecordSource::unknown] += all.each[best] - kept;
    all.each[best] = kept;
  }
  found.drift = 0.5 * all[RecordSource::sensor];
  all[RecordSource::sensor] = found.drift;
  all[RecordSource::disturbance] += found.drift;
  return found;
}

}  // namespace mpm
