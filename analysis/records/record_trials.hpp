#pragma once

#include <functional>
#include <memory>

#include "analysis/records/record_assessment.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

// The simulated records beside a record: loops of the same controller, judged as it is.

namespace mpm {

/// How often simulated records of which the same source was said have it.
using CountsOfSource = std::function<TrialCounts(RecordSource)>;

/// Has the loops like the record run, and puts what they say into the assessment. What is returned asks the
/// first method for its sources; empty without such loops.
CountsOfSource add_trial(RecordAssessment& assessment, const Study& study,
                         const std::shared_ptr<const RecordFrame>& frame, int trials,
                         const TrialRunner& run_trials);

}  // namespace mpm
