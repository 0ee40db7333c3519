#pragma once

#include <string>
#include <vector>

#include "analysis/study_files/thesis_table.hpp"
#include "scenarios/study/study.hpp"

// One key of a study with another value, from a command line.

namespace mpm {

/// "controller.mv.v1.move_suppression" and "10".
struct StudyChange {
  std::string key;    ///< with dots; an entry of a list of tables by its name: "scenario.M3.parameter"
  std::string value;  ///< as it stands in a study file (TOML); empty: the key is taken out
};

/// The change that "KEY=VALUE" asks for. Errors: InputError without "=" or without a key, or for a value that
/// is no TOML.
StudyChange parse_study_change(const std::string& text);

/// The changes that several of them ask for.
std::vector<StudyChange> parse_study_changes(const std::vector<std::string>& texts);

/// The study whose text has these values, laid over it in their order as those of a variant
/// (read_study_variant()); without changes the study itself. `name` stands for the file in messages, and
/// paths in the study are from its folder.
///
/// Errors: InputError for a name that is not in its list, a key to be taken out that is not there; as
/// load_study() for what comes out, which refuses unknown keys.
Study changed_study(const Study& study, const std::vector<StudyChange>& changes, const std::string& name);

/// Makes these changes to every study of the table, after those of its variants. Errors: as changed_study();
/// InputError when a scenario, CV or MV that the rows name is gone.
void change_studies(ThesisTable& table, const std::vector<StudyChange>& changes);

}  // namespace mpm
