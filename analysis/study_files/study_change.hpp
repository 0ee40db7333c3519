#pragma once

#include <string>
#include <vector>

#include "analysis/study_files/thesis_table.hpp"
#include "scenarios/study/study.hpp"

// Changes of single keys of a study, from a command line.

namespace mpm {

/// A key and its new value, such as "controller.mv.v1.move_suppression" and "10".
struct StudyChange {
  std::string key;    ///< with dots; a table in a list is given by its name: "scenario.M3.parameter"
  std::string value;  ///< as in a study file (TOML); if empty, the key is removed
};

/// Reads a change "KEY=VALUE". Errors: InputError for a missing "=", a missing key, or a value that is not
/// valid TOML.
StudyChange parse_study_change(const std::string& text);

/// Reads several changes "KEY=VALUE".
std::vector<StudyChange> parse_study_changes(const std::vector<std::string>& texts);

/// Returns the study with these changes, which are laid over its text in their order like those of a variant
/// (read_study_variant()). Without changes, returns the study itself. `name` stands for the file in messages,
/// and paths in the study are relative to its folder.
///
/// Errors: InputError for a name that is not in its list, or for a key to be removed that the study does not
/// have; as load_study() for the changed study, which also refuses unknown keys.
Study changed_study(const Study& study, const std::vector<StudyChange>& changes, const std::string& name);

/// Makes these changes to every study of the table, after the changes of its variants. Errors: as
/// changed_study(); InputError if the changes remove a scenario, CV or MV that a row names.
void change_studies(ThesisTable& table, const std::vector<StudyChange>& changes);

}  // namespace mpm
