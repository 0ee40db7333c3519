#include "analysis/study_files/study_variant.hpp"

#include <sstream>
#include <vector>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

/// Removes the value under a dotted key; returns false if there is none.
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

}  // namespace

void lay_over(toml::table& target, const toml::table& changes) {
  for (const auto& [key, value] : changes) {
    toml::table* const inner = target.get_as<toml::table>(key.str());
    if (inner != nullptr && value.is_table())
      lay_over(*inner, *value.as_table());
    else
      target.insert_or_assign(key.str(), value);
  }
}

Study read_base_study(const TomlTable& heading, const std::filesystem::path& folder) {
  const std::string name = read_text(heading, "study");
  return heading.located("study", [&] {
    return name.find('/') != std::string::npos || std::filesystem::path(name).extension() == ".toml"
               ? load_study(folder / name)
               : find_study(name);
  });
}

void make_changes(toml::table& study, const TomlTable& changes) {
  for (const std::string& key : removed_keys(changes))
    if (!take_out(study, key))
      changes.refuse("remove", in_quotes(key), "keys that the base study has");
  const toml::node* const set = changes.find("set");
  if (set == nullptr)
    return;
  if (!set->is_table())
    changes.refuse("set", describe(*set), "a table of study keys");
  lay_over(study, *set->as_table());
}

Study study_of(const toml::table& text, const std::string& name, std::shared_ptr<const MethodTable> methods) {
  std::ostringstream stream;
  stream << text << '\n';
  return parse_study(stream.str(), name, std::move(methods));
}

Study read_study_variant(const TomlTable& variant, const toml::table& base, const std::string& name) {
  toml::table study = base;
  variant.require("set", "a table of study keys");
  make_changes(study, variant);
  return study_of(study, name);
}

}  // namespace mpm
