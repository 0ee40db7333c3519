#pragma once

#include <string>

#include "results/document/document.hpp"
#include "results/gates/gate_check.hpp"

namespace mpm {

/// Makes a table with one row per gate: limit, measured number, interval, margin, outcome.
Table gate_table(const GateCheck& check);

/// Makes the outcome of the gates for a run, short enough for the summary of a build server: the verdict, the
/// table, why gates did not pass, and how many verdicts differ from the baseline. Its data (document_json())
/// are complete. `check` must outlive the document; `archive` is what was checked.
Document gates_document(const GateCheck& check, const std::string& archive);

}  // namespace mpm
