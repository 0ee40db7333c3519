#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/records/record_alternatives.hpp"
#include "analysis/records/record_verdict.hpp"

// What a verdict rests on, from the answers of methods on the record and on simulated ones.

namespace mpm {

/// The threshold of a number of model_check_method(), in the place `method` of the answers, for each of its
/// rows, above which at most kTrialFalseAlarms of the simulated records without a fault are in some row: its
/// conformal threshold at this share over the rows, or the largest. NaN without such records.
Eigen::VectorXd number_thresholds(const RecordRange& records, std::size_t method, const std::string& number,
                                  Eigen::Index rows);

/// Simulated records by the side of their threshold (TrialFindings::threshold_for()) on which their answer in
/// the place `method`, of which `found` is, lies, and how often the first of their answers has the right
/// source where it says what is `named`; `unknown`: no source is.
TrialCounts trial_counts(const RecordRange& records, std::size_t method, const TrialFindings& found,
                         RecordSource named = RecordSource::unknown);

/// The experiments of those above it.
std::vector<std::int64_t> unexplained_records(const RecordRange& records, std::size_t method,
                                              const TrialFindings& found);

/// The posterior of `likelihood` on the record. Where the method of the verdict flags the record and sees
/// another source in its worst CV than the most probable one there, this and the most probable one of the
/// record change places: it has asked more. Where it leaves open whether it is a mismatch or a disturbance,
/// both are as probable.
OfSources source_weights(const AssessmentRecord& likelihood, const AssessmentRecord& said);

/// Weights of the sources, and what they have of a CV that drifts.
struct SourceWeights {
  OfSources of = {};
  /// Part of the weights of sensor and of disturbance each: in a closed loop a sensor that drifts and a
  /// disturbance on its CV that grows as fast look the same.
  double drift = 0.0;
};

/// The weights where further hypotheses count, each by its likelihood (RecordAlternatives): mismatch and
/// both, and disturbance, as probable before as `weights` has them, at least 1 in 100; valve, drift and data
/// a tenth as probable, a drift by either of its causes. Where RecordAlternatives::fit
/// of the most probable one is r > 1 times `most_fit`, or r times 1 if this is more, 1 - 1 / r^2 of its
/// weight goes to none of these.
SourceWeights with_alternatives(const OfSources& weights, const RecordAlternatives& alternatives,
                                double most_fit);

/// The threshold of kFitNumber: as number_thresholds(), of simulated records without a mismatch.
double fit_threshold(const RecordRange& records, std::size_t method);

}  // namespace mpm
