#include "analysis/study_files/study_library.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudyExtension = ".toml";

/// Returns the study files of a folder, sorted.
std::vector<fs::path> study_files(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code no_status;
    if (entry->path().extension() == kStudyExtension && entry->is_regular_file(no_status)) {
      files.push_back(entry->path());
    }
  }
  if (error) {
    throw InputError("folder of the shipped studies",
                     fmt::format("'{}' ({})", directory.string(), error.message()),
                     "a folder that can be read (environment variable MPMBENCH_STUDIES)");
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_file(const fs::path& path) {
  std::error_code no_status;
  return fs::is_regular_file(path, no_status);
}

[[noreturn]] void refuse_unknown(const std::string& name, const fs::path& directory) {
  std::vector<std::string> names;
  for (const fs::path& file : study_files(directory)) {
    names.push_back(file.stem().string());
  }
  throw InputError("study", with_nearest(name, names),
                   fmt::format("a path, or one of {}", fmt::join(names, ", ")));
}

}  // namespace

fs::path study_directory() {
  if (const char* const directory = std::getenv("MPMBENCH_STUDIES");
      directory != nullptr && *directory != '\0') {
    return directory;
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (program.parent_path() / MPMBENCH_STUDIES_FROM_PROGRAM).lexically_normal();
  return fs::is_directory(installed, error) ? installed : fs::path(MPMBENCH_STUDY_DIR);
}

std::vector<StudyEntry> shipped_studies(const fs::path& directory) {
  std::vector<StudyEntry> studies;
  for (const fs::path& file : study_files(directory)) {
    studies.push_back({file.stem().string(), load_study(file).title, file});
  }
  return studies;
}

Study find_study(const std::string& path_or_name, const fs::path& directory) {
  if (path_or_name == "-")
    return load_study(std::cin, "standard input");
  const bool names_a_path =
      path_or_name.find('/') != std::string::npos || fs::path(path_or_name).extension() == kStudyExtension;
  if (names_a_path) {
    return load_study(path_or_name);
  }
  const fs::path shipped = directory / (path_or_name + kStudyExtension);
  if (!path_or_name.empty() && is_file(shipped)) {
    return load_study(shipped);
  }
  if (is_file(path_or_name)) {
    return load_study(path_or_name);
  }
  refuse_unknown(path_or_name, directory);
}

}  // namespace mpm
