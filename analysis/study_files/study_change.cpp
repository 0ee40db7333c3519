#include "analysis/study_files/study_change.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_variant.hpp"
#include "base/error.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::string_view kPlaceholder = "value";

/// Returns a table with this value alone, under kPlaceholder. Refuses a line break, which would begin another
/// key.
toml::table parse_value(const std::string& value, const std::string& name) {
  if (value.find('\n') != std::string::npos)
    throw InputError(name, "a line break in a value", "a value of one line");
  return parse_toml(fmt::format("{} = {}", kPlaceholder, value), name);
}

std::vector<std::string> split_at_dots(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key);
  for (std::string part; std::getline(stream, part, '.');)
    parts.push_back(part);
  return parts;
}

/// Returns the table in the list whose key `name` has this value.
toml::table& named_entry(toml::array& list, const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (toml::node& entry : list) {
    toml::table* const table = entry.as_table();
    const toml::value<std::string>* const entry_name =
        table != nullptr ? table->get_as<std::string>("name") : nullptr;
    if (entry_name == nullptr)
      throw InputError(where, "a list without names", "a key in a table, or the whole list as a value");
    if (entry_name->get() == name)
      return *table;
    names.push_back(entry_name->get());
  }
  throw InputError(where, with_nearest(name, names), fmt::format("{}", fmt::join(names, ", ")));
}

/// Returns the table that holds the last part of the key. Tables that do not exist are created empty.
toml::table& owner_of_last(toml::table& study, const std::vector<std::string>& parts,
                           const std::string& where) {
  toml::table* owner = &study;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    toml::node* const node = owner->get(parts[i]);
    if (node == nullptr)
      owner = owner->insert(parts[i], toml::table()).first->second.as_table();
    else if (toml::array* const list = node->as_array(); list != nullptr && i + 2 < parts.size())
      owner = &named_entry(*list, parts[++i], where);
    else if (node->is_table())
      owner = node->as_table();
    else
      throw InputError(where, in_quotes(parts[i]) + ", which is " + describe(*node),
                       "keys of tables, and names in lists of tables");
  }
  return *owner;
}

void apply(toml::table& study, const StudyChange& change, const std::string& name) {
  const std::string where = fmt::format("{}: {}", name, change.key);
  const std::vector<std::string> parts = split_at_dots(change.key);
  toml::table& owner = owner_of_last(study, parts, where);
  if (change.value.empty()) {
    if (owner.erase(parts.back()) == 0)
      throw InputError(where, "a key that the study does not have", "a key of the study");
    return;
  }
  toml::table value = parse_value(change.value, where);
  toml::table laid_over;
  laid_over.insert(parts.back(), *value.get(kPlaceholder));
  lay_over(owner, laid_over);
}

void refuse_missing(const std::string& what, const std::string& name, const std::string& label,
                    const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError(label, fmt::format("a change that removes {} {}", what, in_quotes(name)),
                     "changes that keep the scenarios, CVs and MVs of the table");
}

void require_what_rows_name(const ThesisTable& table, const std::string& label) {
  for (const TableRow& row : table.rows) {
    const Study& study = table.studies.at(row.variant);
    std::vector<std::string> scenarios, cvs{""}, mvs{""};  // a cell of the whole loop has neither
    for (const Scenario& scenario : study.scenarios)
      scenarios.push_back(scenario.name);
    for (const PlantModel::Variable& cv : study.plant.cvs)
      cvs.push_back(cv.name);
    for (const PlantModel::Variable& mv : study.plant.mvs)
      mvs.push_back(mv.name);
    if (!row.scenario.empty())
      refuse_missing("scenario", row.scenario, label, scenarios);
    for (const TableCell& cell : row.cells) {
      refuse_missing("CV", cell.cv, label, cvs);
      refuse_missing("MV", cell.mv, label, mvs);
    }
  }
}

}  // namespace

StudyChange parse_study_change(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set", in_quotes(text), "KEY=VALUE");
  StudyChange change{text.substr(0, equals), text.substr(equals + 1)};
  const std::vector<std::string> parts = split_at_dots(change.key);
  if (change.key.back() == '.' ||
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); }))
    throw InputError("--set", in_quotes(change.key), "keys between single dots");
  if (!change.value.empty())
    parse_value(change.value, "--set " + change.key);
  return change;
}

std::vector<StudyChange> parse_study_changes(const std::vector<std::string>& texts) {
  std::vector<StudyChange> changes;
  for (const std::string& text : texts)
    changes.push_back(parse_study_change(text));
  return changes;
}

Study changed_study(const Study& study, const std::vector<StudyChange>& changes, const std::string& name) {
  if (changes.empty())
    return study;
  toml::table toml = parse_toml(study.source, name);
  for (const StudyChange& change : changes)
    apply(toml, change, name);
  std::stringstream text;
  text << toml << '\n';
  return load_study(text, name, study.assessment.table);
}

void change_studies(ThesisTable& table, const std::vector<StudyChange>& changes) {
  if (changes.empty())
    return;
  const std::string label = table.label() + " with --set";
  for (auto& [variant, study] : table.studies)
    study = changed_study(study, changes, variant.empty() ? label : fmt::format("{} ({})", label, variant));
  require_what_rows_name(table, label);
}

}  // namespace mpm
