#pragma once

#include <string>

#include "results/gates/gate_check.hpp"

namespace mpm {

/// What the gates say about a run, for people: a line a gate with limit, measured number, interval and
/// margin; then why the gates that did not pass did not, and which verdicts differ from the baseline.
std::string gates_text(const GateCheck& check);

/// Why the check fails: a line for each gate that stops it, and the verdict. Empty if the check passes.
std::string stopped_text(const GateCheck& check);

/// The same as JUnit XML for the servers that run tests: a test suite named after the study or suite, a test
/// case a gate. Cases have the names of their gates, without limits, so that a server follows them over runs;
/// a second gate on a number is "NAME (2)". A gate that stops the run is a `failure` (type "fail" or
/// "inconclusive"), an inconclusive one that does not is `skipped`. The seconds of the run stand with the
/// case `experiments` and with the suite: judging takes none. `archive` is what was checked.
std::string gates_junit(const GateCheck& check, const std::string& archive);

/// The verdict as an endpoint of shields.io (https://shields.io/badges/endpoint-badge): JSON from which the
/// service draws a badge. Green: passed; yellow: passed with inconclusive gates; red: failed.
std::string gates_badge(const GateCheck& check);

}  // namespace mpm
