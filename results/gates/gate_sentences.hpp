#pragma once

#include <string>

#include "analysis/findings/gate.hpp"
#include "results/gates/gate_check.hpp"

namespace mpm {

// Words for a judged gate, the same for people and for JUnit.

/// The claim: ">= 90.0 %", "0.2 to 0.4".
std::string limit_text(const GateResult& result);
/// The measured number: "97.2 %"; "-" if there is none.
std::string measured_text(const GateResult& result);
/// Its interval: "90.3 to 99.2 %"; "-" if there is none.
std::string interval_text(const GateResult& result);
/// The distance by which the gate passed or failed, with a sign: "+7.2 pp" (percentage points) for a share,
/// "-0.13".
std::string margin_text(const GateResult& result);
/// The outcome in one sentence, with the number, the limit and the reason for the limit.
std::string explanation(const GateResult& result, double confidence);

/// The check as a whole: "PASSED: 5 of 5 gates pass, 0 fail, 0 inconclusive".
std::string verdict_sentence(const GateCheck& check);

/// The values of a key that differs: "0.1 -> 0.9"; "not there" for a run that does not have it.
std::string difference_text(const StudyDifference& difference);

/// The experiments whose verdicts changed, one per line: "     17  lost    right -> wrong".
std::string changes_text(const JudgementChanges& changes);

/// Details on a gate that did not pass, beyond its explanation: for a gate on the baseline the changed
/// experiments, otherwise nothing.
std::string details_text(const GateCheck& check, const GateResult& result);

}  // namespace mpm
