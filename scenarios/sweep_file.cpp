#include "scenarios/sweep_file.hpp"

#include <sstream>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "scenarios/study_file.hpp"
#include "scenarios/study_library.hpp"
#include "scenarios/toml_file.hpp"
#include "scenarios/toml_table.hpp"
#include "scenarios/toml_text.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".toml";

/// Lays `changes` over `target`: tables key by key, everything else as a whole.
void lay_over(toml::table& target, const toml::table& changes) {
  for (const auto& [key, value] : changes) {
    toml::table* const inner = target.get_as<toml::table>(key.str());
    if (inner != nullptr && value.is_table())
      lay_over(*inner, *value.as_table());
    else
      target.insert_or_assign(key.str(), value);
  }
}

/// Takes out the value under a dotted key; false when there is none.
bool take_out(toml::table& table, const std::string& dotted_key) {
  const std::size_t dot = dotted_key.rfind('.');
  if (dot == std::string::npos)
    return table.erase(dotted_key) > 0;
  toml::table* const parent = table.at_path(dotted_key.substr(0, dot)).as_table();
  return parent != nullptr && parent->erase(dotted_key.substr(dot + 1)) > 0;
}

std::vector<std::string> removed_keys(const TomlTable& variant) {
  std::vector<std::string> keys;
  if (const toml::node* const node = variant.find("remove")) {
    const toml::array* const list = node->as_array();
    if (list == nullptr)
      variant.refuse("remove", describe(*node), "a list of keys of the base study");
    for (const toml::node& key : *list) {
      if (!key.is_string())
        variant.refuse("remove", describe(key), "keys of the base study, as text");
      keys.push_back(**key.as_string());
    }
  }
  return keys;
}

SweepVariant read_variant(const TomlTable& variant, const toml::table& base, const std::string& file_name) {
  SweepVariant result;
  result.choice = read_text(variant, "choice");
  result.value = read_text(variant, "value");
  toml::table study = base;
  for (const std::string& key : removed_keys(variant))
    if (!take_out(study, key))
      variant.refuse("remove", in_quotes(key), "keys that the base study has");
  const toml::node& changes = variant.require("set", "a table of study keys");
  if (!changes.is_table())
    variant.refuse("set", describe(changes), "a table of study keys");
  lay_over(study, *changes.as_table());
  std::ostringstream text;
  text << study << '\n';
  result.study = parse_study(text.str(), fmt::format("{} ({} = {})", file_name, result.choice, result.value));
  return result;
}

Study base_study(const TomlTable& heading, const fs::path& sweep_file) {
  const std::string name = read_text(heading, "study");
  return heading.located("study", [&] {
    return name.find('/') != std::string::npos || fs::path(name).extension() == kExtension
               ? load_study(sweep_file.parent_path() / name)
               : find_study(name);
  });
}

}  // namespace

Sweep load_sweep(const fs::path& path) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a sweep file"), file_name);
  const TomlTable document(toml, file_name, {"sweep", "variant"});
  const TomlTable heading = document.table("sweep", {"name", "title", "study"});
  Sweep sweep;
  sweep.name = read_name(heading, "name");
  sweep.title = read_text(heading, "title");
  sweep.variants.push_back({"", "", base_study(heading, path)});
  const toml::table base = parse_toml(sweep.variants.front().study.source, file_name);
  for (const TomlTable& variant : document.tables("variant", {"choice", "value", "remove", "set"}))
    sweep.variants.push_back(read_variant(variant, base, file_name));
  return sweep;
}

Sweep find_sweep(const std::string& path_or_name) {
  const fs::path shipped = study_directory().parent_path() / "sweeps" / (path_or_name + kExtension);
  std::error_code no_status;
  return load_sweep(path_or_name.find('/') == std::string::npos && fs::is_regular_file(shipped, no_status)
                        ? shipped
                        : fs::path(path_or_name));
}

}  // namespace mpm
