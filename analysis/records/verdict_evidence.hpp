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

/// Thresholds of a number of model_check_method(), one for each of its rows. At most kTrialFalseAlarms of the
/// simulated records without a fault are above the threshold of any row. Each is the conformal threshold at
/// this share divided by the number of rows, or the largest value. NaN without such records. `method` is the
/// place of model_check_method() among the answers.
Eigen::VectorXd number_thresholds(const RecordRange& records, std::size_t method, const std::string& number,
                                  Eigen::Index rows);

/// Counts the simulated records above and below their threshold (TrialFindings::threshold_for()) by the
/// answer in the place `method`, to which `found` belongs. Of those above it whose first answer names the
/// source `named`, it counts how many have this source; `unknown`: none are counted.
TrialCounts trial_counts(const RecordRange& records, std::size_t method, const TrialFindings& found,
                         RecordSource named = RecordSource::unknown);

/// The indices of the experiments above their threshold.
std::vector<std::int64_t> unexplained_records(const RecordRange& records, std::size_t method,
                                              const TrialFindings& found);

/// Copies from the answer of `mpmbench` the weight of each source, and the likeliest fault of each kind.
/// `most_fit` is the threshold of kFitNumber: what the inputs still explain beyond it gives weight to "none
/// of these" (with_none_of_these()).
void take_sources(const AssessedLoop& loop, const AssessmentRecord& mpmbench, double most_fit,
                  VerdictEvidence& evidence);

/// The threshold of kFitNumber, as number_thresholds() has it, over simulated records without a mismatch.
double fit_threshold(const RecordRange& records, std::size_t method);

}  // namespace mpm
