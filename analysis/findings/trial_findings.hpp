#pragma once

#include <cstddef>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/method_rates.hpp"

namespace mpm {

/// How far an answer on a record is to be trusted: what the same method made of simulated loops like it
/// (scenarios/files/recorded_study.hpp), of which the truth is known.
struct TrialFindings {
  MethodRates rates;  ///< over all of these loops
  Rate as_high;       ///< loops without a fault whose score is as high as that of the record
  Rate same_source;   ///< of the flagged loops with the source that the answer names, those that have it
};

/// `said` is the answer on the record by the method in place `method` of the assessments of each of
/// `records`. Nothing is counted in `same_source` when the answer names no source.
TrialFindings trial_findings(const Study& trial, std::size_t method, const RecordRange& records,
                             const AssessmentRecord& said);

}  // namespace mpm
