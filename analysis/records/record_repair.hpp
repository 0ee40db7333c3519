#pragma once

#include "analysis/records/assessed_record.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_verdict.hpp"

// The repair of a model that a record calls for.

namespace mpm {

/// Puts what the corrected channel promises into the assessment, when the verdict is about the model, and
/// what the repair of each channel would bring.
void add_repair(RecordAssessment& assessment, const RecordFrame& frame, VerdictEvidence& evidence);

/// Is nothing left but the usual background, once the channel of the repair is as it is? Of a fault that
/// begins within the record its later half counts, in which it has grown.
bool is_mismatch_alone(const RecordAssessment& assessment, const RecordFrame& frame);

}  // namespace mpm
