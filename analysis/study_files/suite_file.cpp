#include "analysis/study_files/suite_file.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/study_programs.hpp"
#include "analysis/study_files/study_variant.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSuiteExtension = ".toml";

const std::vector<std::string> kPlantKeys{"name", "study", "remove", "set"};
const std::vector<std::string> kFamilyKeys{"name", "title", "plants", "reference", "remove", "set"};
const std::vector<std::string> kCellKeys{"plant", "family", "remove", "set"};

std::vector<std::string> names_of(const std::vector<SuiteAxis>& axis) {
  std::vector<std::string> names;
  for (const SuiteAxis& entry : axis)
    names.push_back(entry.name);
  return names;
}

/// A plant of the file with its text, before the changes of the families.
struct BasePlant {
  SuiteAxis axis;
  toml::table text;
};

BasePlant read_base_plant(const TomlTable& plant, const fs::path& folder, const std::string& file_name) {
  const Study study = read_base_study(plant, folder);
  BasePlant base{{.name = read_name(plant, "name"), .title = study.title},
                 parse_toml(study.source, file_name)};
  make_changes(base.text, plant);
  return base;
}

/// The changes of a family, and the plants that it has.
struct FamilyChanges {
  SuiteAxis axis;
  TomlTable changes;
  std::vector<std::size_t> plants;
};

FamilyChanges read_family(const TomlTable& family, const std::vector<std::string>& plant_names) {
  std::vector<std::size_t> plants;
  if (family.has("plants"))
    plants = read_some_of(family, "plants", plant_names);
  else
    for (std::size_t plant = 0; plant < plant_names.size(); ++plant)
      plants.push_back(plant);
  return {{read_name(family, "name"), read_text(family, "title"), read_flag_or(family, "reference", false)},
          family,
          plants};
}

/// Refuses a name that occurs twice in the list: archives would overwrite each other.
void require_distinct(const std::vector<SuiteAxis>& axis, const TomlTable& document, const char* key) {
  const std::vector<std::string> names = names_of(axis);
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      document.refuse(key, fmt::format("{} twice", in_quotes(*name)), "every name once");
}

/// Changes of single cells, by plant and family.
using CellChanges = std::map<std::pair<std::size_t, std::size_t>, TomlTable>;

CellChanges read_cell_changes(const TomlTable& document, const std::vector<std::string>& plants,
                              const std::vector<FamilyChanges>& families) {
  CellChanges changes;
  if (!document.has("cell"))
    return changes;
  std::vector<std::string> family_names;
  for (const FamilyChanges& family : families)
    family_names.push_back(family.axis.name);
  for (const TomlTable& cell : document.tables("cell", kCellKeys)) {
    const std::size_t plant = read_one_of(cell, "plant", plants);
    const std::size_t family = read_one_of(cell, "family", family_names);
    const std::vector<std::size_t>& of_family = families[family].plants;
    if (std::find(of_family.begin(), of_family.end(), plant) == of_family.end())
      cell.refuse("plant", in_quotes(plants[plant]), "a plant of the family");
    if (!changes.emplace(std::pair(plant, family), cell).second)
      cell.refuse("", fmt::format("{}.{} a second time", plants[plant], family_names[family]),
                  "every cell once");
  }
  return changes;
}

/// Returns the seed of a cell. Plants and families may be appended without a change to the seeds of the
/// others.
std::uint64_t cell_seed(std::uint64_t suite_seed, std::size_t plant, std::size_t family) {
  constexpr std::uint64_t kMostFamilies = 1U << 16U;
  constexpr int kSpareBits = 11;  // of 64, so that a double can hold the seed
  return RandomStream(suite_seed, plant * kMostFamilies + family, StreamId::suite_cell).bits() >> kSpareBits;
}

/// Gives the text its own seed, name and title.
void name_cell(toml::table& text, const Suite& suite, const SuiteCell& cell) {
  const SuiteAxis& plant = suite.plants[cell.plant];
  const SuiteAxis& family = suite.families[cell.family];
  toml::table heading;
  heading.insert("name", fmt::format("{}-{}", plant.name, family.name));
  heading.insert("title", fmt::format("{} {}, {}: {}", suite.name, suite.version, plant.name, family.title));
  heading.insert("seed", static_cast<std::int64_t>(cell_seed(suite.seed, cell.plant, cell.family)));
  text.insert_or_assign("study", std::move(heading));
}

/// Returns whether the name is among the chosen ones; an empty list means all.
bool is_chosen(const std::string& name, const std::vector<std::string>& chosen) {
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

void require_known(const std::vector<std::string>& chosen, const std::vector<SuiteAxis>& axis,
                   const char* what) {
  const std::vector<std::string> names = names_of(axis);
  for (const std::string& name : chosen)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(what, with_nearest(name, names), fmt::format("{}", fmt::join(names, ", ")));
}

std::vector<std::string> shipped_suites(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == kSuiteExtension)
      names.push_back(entry->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::string Suite::name_of(std::size_t plant, std::size_t family) const {
  return fmt::format("{}.{}", plants[plant].name, families[family].name);
}

Suite load_suite(const fs::path& path, const SuiteChoice& choice) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a suite file"), file_name);
  const TomlTable document(toml, file_name, {"suite", "common", "plant", "family", "cell"});
  const TomlTable heading = document.table("suite", {"name", "version", "title", "seed", "methods"});
  Suite suite;
  suite.path = path;
  suite.name = read_name(heading, "name");
  suite.version = read_text(heading, "version");
  suite.title = read_text(heading, "title");
  suite.seed = choice.seed.value_or(
      static_cast<std::uint64_t>(read_whole(heading, "seed", 0, std::numeric_limits<std::int64_t>::max())));
  suite.methods = read_texts_or(heading, "methods", "names of methods, or all", {"all"});

  std::vector<BasePlant> plants;
  for (const TomlTable& plant : document.tables("plant", kPlantKeys)) {
    plants.push_back(read_base_plant(plant, path.parent_path(), file_name));
    suite.plants.push_back(plants.back().axis);
  }
  require_distinct(suite.plants, document, "plant");
  std::vector<FamilyChanges> families;
  for (const TomlTable& family : document.tables("family", kFamilyKeys)) {
    families.push_back(read_family(family, names_of(suite.plants)));
    suite.families.push_back(families.back().axis);
  }
  require_distinct(suite.families, document, "family");
  require_known(choice.plants, suite.plants, "plant of the suite");
  require_known(choice.families, suite.families, "family of the suite");
  const CellChanges of_cells = read_cell_changes(document, names_of(suite.plants), families);
  const TomlTable common = document.table_or_empty("common", {"remove", "set"});

  for (std::size_t plant = 0; plant < plants.size(); ++plant) {
    for (std::size_t family = 0; family < families.size(); ++family) {
      const std::vector<std::size_t>& of_family = families[family].plants;
      if (std::find(of_family.begin(), of_family.end(), plant) == of_family.end() ||
          !is_chosen(suite.plants[plant].name, choice.plants) ||
          !is_chosen(suite.families[family].name, choice.families))
        continue;
      SuiteCell cell{plant, family, {}};
      toml::table text = plants[plant].text;
      if (common.is_there())
        make_changes(text, common);
      make_changes(text, families[family].changes);
      if (const auto own = of_cells.find({plant, family}); own != of_cells.end())
        make_changes(text, own->second);
      name_cell(text, suite, cell);
      cell.study = study_of(text, fmt::format("{} ({})", file_name, suite.name_of(cell)));
      trust_programs_of(cell.study);
      suite.cells.push_back(std::move(cell));
    }
  }
  if (suite.cells.empty())
    throw InputError("cells of the suite", "none", "a plant and a family that has it");
  return suite;
}

Suite find_suite(const std::string& path_or_name, const SuiteChoice& choice) {
  const bool names_a_path =
      path_or_name.find('/') != std::string::npos || fs::path(path_or_name).extension() == kSuiteExtension;
  if (names_a_path)
    return load_suite(path_or_name, choice);
  const fs::path folder = study_directory().parent_path() / "suites";
  const fs::path shipped = folder / (path_or_name + kSuiteExtension);
  std::error_code no_status;
  if (fs::is_regular_file(shipped, no_status))
    return load_suite(shipped, choice);
  const std::vector<std::string> names = shipped_suites(folder);
  throw InputError("suite", with_nearest(path_or_name, names),
                   fmt::format("a path, or one of {}", fmt::join(names, ", ")));
}

}  // namespace mpm
