#pragma once

#include <string>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"

// The tables of the thesis beside ours, for people and for programs. `changes` are those made to all studies,
// KEY=VALUE.

namespace mpm {

/// A table a paragraph: in each cell ours, the thesis's in brackets, and "x" where the verdicts differ; then
/// the agreement of each table and in total.
std::string reproduction_text(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes = {});

/// {"tables": [{"number", "title", "note", "agreeing", "judged", "rows": [{"label", "remark", "cells":
/// [{"head", "cv", "quantity", "ours", "thesis", "ratio", "our_verdict", "thesis_verdict", "agrees"}]}]}],
/// "agreeing", "judged"}; null where there is no number or verdict. With changes they are there as "set".
std::string reproduction_json(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes = {});

/// The same as one HTML page in the style of the report, with the rules of each table.
std::string reproduction_html(const std::vector<ReproducedTable>& tables, const std::string& version,
                              const std::vector<std::string>& changes = {});

}  // namespace mpm
