#pragma once

#include <string>
#include <vector>

#include "scenarios/files/study_file_keys.hpp"

namespace mpm::testing {

/// Checks that the document of a TOML file format has exactly these keys. It has a heading "## `table`" (or
/// "## Top level") a table, and a row "| `key` | ..." a key.
void check_documented_keys(const std::string& document, const std::vector<StudyFileTable>& tables);

}  // namespace mpm::testing
