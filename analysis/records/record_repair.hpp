#pragma once

#include "analysis/records/assessed_record.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_verdict.hpp"

// The repair of a model that a record calls for.

namespace mpm {

/// If the verdict is about the model, adds to the assessment what the corrected channel promises, and what
/// the repair of each channel would bring. If the verdict is a mismatch and a disturbance, and the interval
/// of the fitted parameter holds the value of the model, there is no mismatch: "both" and "disturbance" then
/// exchange their weights.
void add_repair(RecordAssessment& assessment, const RecordFrame& frame, VerdictEvidence& evidence);

/// Returns whether only the usual background is left once the channel of the repair is corrected. If the
/// fault begins within the record, only the later half of the samples since then counts, in which it has
/// grown.
bool is_mismatch_alone(const RecordAssessment& assessment, const RecordFrame& frame);

}  // namespace mpm
