#pragma once

#include <string>
#include <vector>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "analysis/reproduction/table_reproduction.hpp"
#include "results/document/document.hpp"

// The tables of the thesis beside ours, of one run or over several seeds, for people and for programs.
// `changes` are those made to all studies, KEY=VALUE. There must be one table or more.

namespace mpm {

/// In each cell ours, the thesis's in brackets, and a mark where the verdicts differ; and the agreement of
/// each table and in total.
Document reproduction_document(const std::vector<ReproducedTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes = {});
/// In each cell the median of ours, the thesis's in brackets, and the share of the seeds whose verdict
/// agrees.
Document reproduction_document(const std::vector<SeededTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes = {});

/// {"tables": [{"number", "title", "note", "agreeing", "judged", "rows": [{"label", "remark", "cells":
/// [{"head", "cv", "quantity", "ours", "thesis", "ratio", "our_verdict", "thesis_verdict", "agrees"}]}]}],
/// "agreeing", "judged"}; null where there is no number or verdict. With changes they are there as "set".
std::string reproduction_json(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes = {});
/// {"set": [...], "seeds", "tables": [{"number", "figure", "title", "note", "judged", "agreeing": [one a
/// seed], "rows": [{"label", "remark", "cells": [{"head", "cv", "mv", "quantity", "median", "numbers",
/// "thesis", "thesis_verdict", "share"}]}]}], "judged", "mean_agreeing"}; null where there is no number or
/// verdict.
std::string reproduction_json(const std::vector<SeededTable>& tables,
                              const std::vector<std::string>& changes);

}  // namespace mpm
