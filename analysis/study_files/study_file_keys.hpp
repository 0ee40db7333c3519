#pragma once

#include <string_view>
#include <vector>

#include "scenarios/toml/option_keys.hpp"

namespace mpm {

/// All tables of the study file, made from what the reader reads. "DISTRIBUTION" stands for the inline table
/// of a random number, wherever it stands, and "FINDING" for the name of any finding. The top level has the
/// empty name. Of the keys, which refer to no study, only the texts may be used.
const std::vector<KeyTable>& study_file_tables();

/// The keys of one table, which must be there.
const OptionKeys& study_file_keys(std::string_view table);

}  // namespace mpm
