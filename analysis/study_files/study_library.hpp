#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// A study that comes with the program.
struct StudyEntry {
  std::string name;   ///< the file name without ".toml"
  std::string title;  ///< one line for people, as in the file
  std::filesystem::path path;
};

/// Where the shipped studies are: the environment variable MPMBENCH_STUDIES or, when that is unset or empty,
/// the folder beside an installed program, or scenarios/studies of the sources that the program was built
/// from.
std::filesystem::path study_directory();

/// The studies in `directory`, by name. Errors: InputError when it cannot be read, or a study in it cannot.
std::vector<StudyEntry> shipped_studies(const std::filesystem::path& directory = study_directory());

/// The study in a file, or the shipped study of that name. A text with a '/' or with ".toml" at its end is a
/// path; any other one is looked up in `directory` first, and then is the name of a file. "-" is what comes
/// on stdin.
/// Errors: as load_study(); InputError that lists the known names when there is neither.
Study find_study(const std::string& path_or_name, const std::filesystem::path& directory = study_directory());

}  // namespace mpm
