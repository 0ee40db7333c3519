#pragma once

#include <string>
#include <vector>

#include "analysis/reproduction/seeded_reproduction.hpp"

// The tables of the thesis beside ours over several seeds, for people and for programs. `changes` are those
// made to all studies, KEY=VALUE. There must be one table or more.

namespace mpm {

/// A table a paragraph: in each cell the median of ours, the thesis's in brackets, and the share of the seeds
/// whose verdict agrees; then the agreement of each table and in total.
std::string seeded_reproduction_text(const std::vector<SeededTable>& tables,
                                     const std::vector<std::string>& changes);

/// {"set": [...], "seeds", "tables": [{"number", "figure", "title", "note", "judged", "agreeing": [one a
/// seed], "rows":
/// [{"label", "remark", "cells": [{"head", "cv", "mv", "quantity", "median", "numbers", "thesis",
/// "thesis_verdict", "share"}]}]}], "judged", "mean_agreeing"}; null where there is no number or verdict.
std::string seeded_reproduction_json(const std::vector<SeededTable>& tables,
                                     const std::vector<std::string>& changes);

/// The same as one HTML page in the style of the report, with the rules of each table.
std::string seeded_reproduction_html(const std::vector<SeededTable>& tables, const std::string& version,
                                     const std::vector<std::string>& changes);

}  // namespace mpm
