#include "scenarios/toml/toml_draft.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace mpm {

TomlDraft::Entry& TomlDraft::entry(std::string_view key) {
  assert(std::find(key_order_.begin(), key_order_.end(), key) != key_order_.end());
  return entries_[std::string(key)];
}

void TomlDraft::comment(std::string_view key, std::string_view text) {
  entry(key).line = fmt::format("# {}: {}", toml_key(key), text);
}

TomlDraft& TomlDraft::table(std::string_view key, const std::vector<std::string>& key_order) {
  Entry& owner = entry(key);
  if (owner.tables.empty())
    owner.tables.push_back(std::make_unique<TomlDraft>(key_order));
  return *owner.tables.front();
}

TomlDraft& TomlDraft::table_in_list(std::string_view key, std::size_t place,
                                    const std::vector<std::string>& key_order) {
  Entry& owner = entry(key);
  owner.is_list = true;
  if (place == owner.tables.size())
    owner.tables.push_back(std::make_unique<TomlDraft>(key_order));
  return *owner.tables.at(place);
}

bool TomlDraft::has_values() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const auto& entry) { return !entry.second.line.empty(); });
}

void TomlDraft::write(std::string& text, const std::string& path) const {
  // What follows the heading of another table belongs to that table, so values come first.
  for (const std::string& key : key_order_)
    if (const auto found = entries_.find(key); found != entries_.end() && !found->second.line.empty())
      text += found->second.line + '\n';
  for (const std::string& key : key_order_) {
    const auto found = entries_.find(key);
    if (found == entries_.end() || !found->second.line.empty())
      continue;
    const std::string below = path.empty() ? toml_key(key) : path + '.' + toml_key(key);
    for (const std::unique_ptr<TomlDraft>& table : found->second.tables) {
      if (found->second.is_list)
        text += fmt::format("\n[[{}]]\n", below);
      else if (table->has_values())
        text += fmt::format("\n[{}]\n", below);
      table->write(text, below);
    }
  }
}

void TomlDraft::add_changes(std::vector<std::string>& changes, const std::string& path) const {
  for (const std::string& key : key_order_) {
    const auto found = entries_.find(key);
    if (found == entries_.end())
      continue;
    const Entry& entry = found->second;
    const std::string below = path.empty() ? "" : path + '.';
    if (!entry.line.empty() && !entry.fallback.empty() && entry.line != entry.fallback)
      changes.push_back(fmt::format("{}{} (default: {})", below, entry.line,
                                    entry.fallback.substr(entry.fallback.find(" = ") + 3)));
    if (entry.line.empty())
      for (std::size_t i = 0; i < entry.tables.size(); ++i)
        entry.tables[i]->add_changes(changes,
                                     below + toml_key(key) + (entry.is_list ? fmt::format("[{}]", i) : ""));
  }
}

std::vector<std::string> TomlDraft::changes() const {
  std::vector<std::string> changes;
  add_changes(changes, "");
  return changes;
}

std::string TomlDraft::text() const {
  std::string text;
  write(text, "");
  return text.erase(0, text.find_first_not_of('\n'));
}

}  // namespace mpm
