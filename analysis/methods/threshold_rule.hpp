#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "analysis/methods/assessment_record.hpp"

// Methods from outside with MethodProgram::threshold_option. Another threshold changes nothing in an answer
// except
//
//   flagged = score > threshold
//
// for the loop, for each CV with a verdict, and for each window.

namespace mpm {

/// The value of the option `option` in the options of a method, which are JSON.
double threshold_in(const std::string& options, const std::string& option);

/// Everything that the answers of such a method depend on, except this option: the fingerprint of the method
/// without the option.
std::string fingerprint_without(const std::string& option, const MethodDescription& method);

/// Throws BrokenPromise, with `place`, if the method answers more than flags, their scores, and numbers.
void require_threshold_rule(const MethodDescription& method, const std::string& place);

/// Throws BrokenPromise, with `place`, if an answer on a loop breaks the rule: a flag without a score, a flag
/// that contradicts the comparison with the threshold, or no CV although the method names CVs.
void require_threshold_rule(const nlohmann::ordered_json& answer, const Assessment& assessment,
                            const MethodDescription& method, double threshold, const std::string& place);

/// Replaces the flags of an answer of such a method by those that follow from this threshold.
void flag_anew(AssessmentRecord& answer, double threshold);

}  // namespace mpm
