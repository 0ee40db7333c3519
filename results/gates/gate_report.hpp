#pragma once

#include <string>

#include "results/gates/gate_check.hpp"

namespace mpm {

/// What the gates say of a run, for people: a line a gate with limit, measured number, interval and
/// margin; then why the gates that did not pass did not, and which verdicts differ from the baseline.
std::string gates_text(const GateCheck& check);

/// The same as JUnit XML for the servers that run tests: a test suite named after the study or suite, a test
/// case a gate. A gate that stops the run is a `failure` (type "fail" or "inconclusive"), an inconclusive one
/// that does not is `skipped`. `archive` is what was checked.
std::string gates_junit(const GateCheck& check, const std::string& archive);

}  // namespace mpm
