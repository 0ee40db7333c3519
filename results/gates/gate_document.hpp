#pragma once

#include <string>

#include "results/document/document.hpp"
#include "results/gates/gate_check.hpp"

namespace mpm {

/// A row for each gate: limit, measured number, interval, margin, outcome.
Table gate_table(const GateCheck& check);

/// The outcome of the gates for a run, short enough for the summary of a build server: the verdict, the
/// table, why gates did not pass, and how many verdicts differ from the baseline. Its data (document_json())
/// have everything. `check` must outlive it; `archive` is what was checked.
Document gates_document(const GateCheck& check, const std::string& archive);

}  // namespace mpm
