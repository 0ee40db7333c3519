#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// One table of the study file with all its keys. docs/study_file.md says what they mean; a test compares.
///
/// The name is the path of the table. "[]" stands for each table of a list, "NAME" for the name of a
/// variable, "DISTRIBUTION" for the inline table of a random number, wherever it stands, and "FINDING" for
/// the name of any finding. The top level has the empty name.
struct StudyFileTable {
  std::string name;
  std::vector<std::string> keys;
};

/// All tables of the study file. The reader takes no other key than these.
const std::vector<StudyFileTable>& study_file_tables();

/// The keys of one table, which must be there.
const std::vector<std::string>& study_file_keys(std::string_view table);

}  // namespace mpm
