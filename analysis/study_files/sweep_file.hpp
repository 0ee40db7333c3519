#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// One study of a sweep: the base study, or the base study with one choice made differently.
struct SweepVariant {
  std::string choice;  ///< name of the open choice; empty for the base study
  std::string value;   ///< its value in this variant, for people
  Study study;         ///< `source` is its whole text, so that its archive is self-contained
};

/// A sweep shows how much the open choices of a study matter. It has one study for each choice and value;
/// everything else is as in the base study.
struct Sweep {
  std::string name;
  std::string title;
  std::vector<SweepVariant> variants;  ///< the base study first
};

/// Reads a sweep file (docs/suite.md). First the keys in `remove` are removed from the base study; then the
/// tables under `set` are laid over it key by key.
///
/// Errors: InputError "FILE:LINE: KEY: ..." for a mistake in the sweep file itself. If a variant is not a
/// valid study, the file is "FILE (CHOICE = VALUE)", and LINE counts in the text of that variant.
Sweep load_sweep(const std::filesystem::path& path);

/// Returns the sweep in a file, or the shipped sweep of that name in the folder `sweeps` beside the shipped
/// studies.
Sweep find_sweep(const std::string& path_or_name);

}  // namespace mpm
