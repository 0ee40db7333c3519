#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// A plant or a family of a suite.
struct SuiteAxis {
  std::string name;   ///< part of the name of a file
  std::string title;  ///< one line for people
  /// For a family: it draws only faults that the method `ceiling` knows, so that `ceiling` is a reference
  /// there.
  bool has_reference = false;
};

/// A plant under the experiments of a family, which is a study of its own.
struct SuiteCell {
  std::size_t plant = 0;   ///< place in Suite::plants
  std::size_t family = 0;  ///< place in Suite::families
  Study study;             ///< `source` is its whole text, so that its archive is self-contained
};

/// Common experiments for all authors of assessment methods: every plant under every family of experiments
/// that is possible for it.
struct Suite {
  std::string name;
  std::string version;  ///< changes whenever a number of a leaderboard can change
  std::string title;
  std::uint64_t seed = 0;
  std::vector<std::string> methods;
  std::vector<SuiteAxis> plants;
  std::vector<SuiteAxis> families;
  std::vector<SuiteCell> cells;  ///< plant by plant, each in the order of the families
  std::filesystem::path path;    ///< of the suite file

  /// Returns "PLANT.FAMILY" for a cell with these places in `plants` and `families`.
  std::string name_of(std::size_t plant, std::size_t family) const;
  std::string name_of(const SuiteCell& cell) const { return name_of(cell.plant, cell.family); }
};

/// The part of a suite to run. Leaving out a part does not change the rest.
struct SuiteChoice {
  std::optional<std::uint64_t> seed = {};  ///< replaces the seed of the file
  std::vector<std::string> plants = {};    ///< by name; empty: all
  std::vector<std::string> families = {};  ///< by name; empty: all
};

/// Reads a suite file (docs/suite.md). The text of a cell is that of the study of its plant. Laid over it in
/// this order are the changes under `common`, those of the family and those for this cell alone. The seed of
/// a cell is drawn from that of the suite by the place of the cell among plants and families; it is below
/// 2^53 so that JSON can hold it.
///
/// Errors: InputError "FILE:LINE: KEY: ..." for a mistake in the file itself. If a cell is not a valid study,
/// the file is "FILE (PLANT.FAMILY)", and LINE counts in the text of that cell. Also InputError for a name in
/// `choice` that the suite does not have.
Suite load_suite(const std::filesystem::path& path, const SuiteChoice& choice = {});

/// Returns the suite in a file, or the shipped suite of that name in the folder `suites` beside the shipped
/// studies. Errors: as load_suite(); InputError that lists the shipped suites if there is neither.
Suite find_suite(const std::string& path_or_name, const SuiteChoice& choice = {});

}  // namespace mpm
