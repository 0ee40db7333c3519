#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_record.hpp"
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

/// Takes the sources from the answer of `mpmbench`, and what is most likely of each; with `most_fit`, the
/// threshold of kFitNumber, none of these (with_none_of_these()).
void take_sources(const AssessedLoop& loop, const AssessmentRecord& mpmbench, double most_fit,
                  VerdictEvidence& evidence);

/// The threshold of kFitNumber: as number_thresholds(), of simulated records without a mismatch.
double fit_threshold(const RecordRange& records, std::size_t method);

}  // namespace mpm
