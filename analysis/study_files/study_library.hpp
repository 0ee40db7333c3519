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

/// Returns the folder of the shipped studies: the environment variable MPMBENCH_STUDIES or, if that is unset
/// or empty, the folder beside an installed program, or scenarios/studies of the sources from which the
/// program was built.
std::filesystem::path study_directory();

/// Returns the studies in `directory`, sorted by name. Errors: InputError if the folder or a study in it
/// cannot be read.
std::vector<StudyEntry> shipped_studies(const std::filesystem::path& directory = study_directory());

/// Returns the study in a file, or the shipped study of that name. A text with a '/' or with ".toml" at its
/// end is a path. Any other text is looked up in `directory` first and is then taken as the name of a file.
/// "-" reads the study from stdin. Errors: as load_study(); InputError that lists the known names if there is
/// neither a file nor a shipped study.
Study find_study(const std::string& path_or_name, const std::filesystem::path& directory = study_directory());

}  // namespace mpm
