#pragma once

#include <string>
#include <vector>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "analysis/reproduction/table_reproduction.hpp"
#include "results/document/document.hpp"

// The tables of the thesis beside ours, from one run or over several seeds, for people and for programs.
// `changes` are the changes made to all studies, as KEY=VALUE. There must be at least one table.

namespace mpm {

/// Shows in each cell our number, the number of the thesis in brackets, and a mark if the verdicts differ.
/// Also shows the agreement of each table and in total.
Document reproduction_document(const std::vector<ReproducedTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes = {});
/// Shows in each cell the median of our numbers, the number of the thesis in brackets, and the share of the
/// seeds whose verdict agrees.
Document reproduction_document(const std::vector<SeededTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes = {});

/// Returns {"tables": [{"number", "figure", "title", "note", "agreeing", "judged", "rows": [{"label",
/// "remark", "cells": [{"head", "cv", "mv", "quantity", "ours", "thesis", "ratio", "our_verdict",
/// "thesis_verdict", "agrees"}]}]}], "agreeing", "judged"}. A missing number or verdict is null. Changes, if
/// any, are in "set".
std::string reproduction_json(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes = {});
/// Returns {"set": [...], "seeds", "tables": [{"number", "figure", "title", "note", "judged", "agreeing":
/// [one per seed], "rows": [{"label", "remark", "cells": [{"head", "cv", "mv", "quantity", "median",
/// "numbers", "thesis", "thesis_verdict", "share"}]}]}], "judged", "mean_agreeing"}. A missing number or
/// verdict is null.
std::string reproduction_json(const std::vector<SeededTable>& tables,
                              const std::vector<std::string>& changes);

}  // namespace mpm
