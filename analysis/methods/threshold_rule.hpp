#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "analysis/methods/assessment_record.hpp"

// Methods from outside with MethodProgram::threshold_option: an answer with another threshold is the same
// answer, except for
//
//   flagged = score > threshold
//
// of the loop, of each CV of which it says anything, and of each window.

namespace mpm {

/// The value of such an option in options of a method, which are JSON.
double threshold_in(const std::string& options, const std::string& option);

/// Everything except this option that the answers of such a method depend on: its fingerprint without the
/// option.
std::string fingerprint_without(const std::string& option, const MethodDescription& method);

/// Throws BrokenPromise, with `place`, for a method that answers more than what has a score, and numbers.
void require_threshold_rule(const MethodDescription& method, const std::string& place);

/// The same for an answer on a loop that is not what the rule says: a flag without a score, one that is not
/// the comparison with the threshold, or no CV although the method names CVs.
void require_threshold_rule(const nlohmann::ordered_json& answer, const Assessment& assessment,
                            const MethodDescription& method, double threshold, const std::string& place);

/// Makes the flags of an answer of such a method by this threshold.
void flag_anew(AssessmentRecord& answer, double threshold);

}  // namespace mpm
