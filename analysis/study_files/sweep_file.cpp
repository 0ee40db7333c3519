#include "analysis/study_files/sweep_file.hpp"

#include <fmt/format.h>

#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/study_programs.hpp"
#include "analysis/study_files/study_variant.hpp"
#include "base/error.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSweepExtension = ".toml";

SweepVariant read_variant(const TomlTable& variant, const toml::table& base, const std::string& file_name) {
  SweepVariant result;
  result.choice = read_text(variant, "choice");
  result.value = read_text(variant, "value");
  result.study =
      read_study_variant(variant, base, fmt::format("{} ({} = {})", file_name, result.choice, result.value));
  trust_programs_of(result.study);
  return result;
}

}  // namespace

Sweep load_sweep(const fs::path& path) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a sweep file"), file_name);
  const TomlTable document(toml, file_name, {"sweep", "variant"});
  const TomlTable heading = document.table("sweep", {"name", "title", "study", "remove", "set"});
  Sweep sweep;
  sweep.name = read_name(heading, "name");
  sweep.title = read_text(heading, "title");
  const Study shipped = read_base_study(heading, path.parent_path());
  toml::table base = parse_toml(shipped.source, file_name);
  make_changes(base, heading);
  const bool is_changed = heading.find("set") != nullptr || heading.find("remove") != nullptr;
  sweep.variants.push_back({"", "", is_changed ? study_of(base, file_name + " (sweep)") : shipped});
  trust_programs_of(sweep.variants.front().study);
  for (const TomlTable& variant : document.tables("variant", {"choice", "value", "remove", "set"}))
    sweep.variants.push_back(read_variant(variant, base, file_name));
  return sweep;
}

Sweep find_sweep(const std::string& path_or_name) {
  const fs::path shipped = study_directory().parent_path() / "sweeps" / (path_or_name + kSweepExtension);
  std::error_code no_status;
  return load_sweep(path_or_name.find('/') == std::string::npos && fs::is_regular_file(shipped, no_status)
                        ? shipped
                        : fs::path(path_or_name));
}

}  // namespace mpm
