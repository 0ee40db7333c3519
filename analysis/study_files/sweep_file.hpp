#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// One study of a sweep: the base study, or the base study with one choice made otherwise.
struct SweepVariant {
  std::string choice;  ///< which open choice; empty for the base study
  std::string value;   ///< its value in this variant, for people
  Study study;         ///< `source` is the whole text of this variant, so that its archive stands alone
};

/// How much the open choices of a study matter: one study a choice and value, everything else as in the base.
struct Sweep {
  std::string name;
  std::string title;
  std::vector<SweepVariant> variants;  ///< the base study first
};

/// Reads a sweep file (docs/suite.md). The tables under `set` are laid over those of the base study key by
/// key; the keys in `remove` are taken out of it first.
///
/// Errors: InputError "FILE:LINE: KEY: ..." for the sweep file itself; for a variant that is no study the
/// same with "FILE (CHOICE = VALUE)" as the file, where LINE counts in the text of that variant.
Sweep load_sweep(const std::filesystem::path& path);

/// The sweep in a file, or the shipped sweep of that name in the folder `sweeps` beside the shipped studies.
Sweep find_sweep(const std::string& path_or_name);

}  // namespace mpm
