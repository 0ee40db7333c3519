#pragma once

#include <string_view>
#include <vector>

#include "scenarios/toml/option_keys.hpp"

namespace mpm {

/// Returns all tables of the study file, made from the keys of the reader. "DISTRIBUTION" stands for the
/// inline table of a random number in any place, and "FINDING" for the name of any finding. The top level has
/// the empty name. Only the texts of the keys may be used, because the keys refer to no study.
const std::vector<KeyTable>& study_file_tables();

/// Returns the keys of one table, which must exist.
const OptionKeys& study_file_keys(std::string_view table);

}  // namespace mpm
