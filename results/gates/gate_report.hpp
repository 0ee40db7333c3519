#pragma once

#include <string>

#include "results/gates/gate_check.hpp"

namespace mpm {

/// Says for people what the gates show about a run: one line per gate with limit, measured number, interval
/// and margin; then why gates did not pass, and which verdicts differ from the baseline.
std::string gates_text(const GateCheck& check);

/// Says why the check fails: one line for each gate that stops the run, and the verdict. Empty if the check
/// passes.
std::string stopped_text(const GateCheck& check);

/// Returns the check as JUnit XML for servers that run tests: one test suite, named after the study or suite,
/// with one test case per gate. A case has the name of its gate without the limit, so that a server can
/// follow it over several runs; a second gate on a number is "NAME (2)". A gate that stops the run is a
/// `failure` (type "fail" or "inconclusive"); an inconclusive gate that does not is `skipped`. The seconds of
/// the run are given for the case `experiments` and for the suite, because judging takes no time. `archive`
/// is what was checked.
std::string gates_junit(const GateCheck& check, const std::string& archive);

/// Returns the verdict as an endpoint of shields.io (https://shields.io/badges/endpoint-badge): JSON from
/// which the service draws a badge. Green: passed; yellow: passed with inconclusive gates; red: failed.
std::string gates_badge(const GateCheck& check);

}  // namespace mpm
