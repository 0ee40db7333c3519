#include "scenarios/toml/toml_draft.hpp"

#include <algorithm>
#include <cassert>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

/// A long list without its line breaks.
std::string on_one_line(std::string literal) {
  std::erase(literal, '\n');
  return literal;
}

}  // namespace

TomlDraft::Entry& TomlDraft::entry(std::string_view key) {
  assert(std::find(key_order_.begin(), key_order_.end(), key) != key_order_.end());
  return entries_[std::string(key)];
}

void TomlDraft::comment(std::string_view key, std::string_view text) {
  entry(key).value = text;
  entry(key).is_comment = true;
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
                     [](const auto& entry) { return !entry.second.value.empty(); });
}

TomlDraft& TomlDraft::explain(std::string_view kind, std::map<std::string, std::string> meanings) {
  kind_ = kind;
  meanings_ = std::move(meanings);
  return *this;
}

/// The comment above a key; empty if the key already has its comment, or has no meaning.
std::string TomlDraft::explanation(const std::string& key, Explained& explained) const {
  constexpr std::size_t kWidth = 100;
  const auto found = meanings_.find(key);
  if (found == meanings_.end() || !explained.emplace(kind_, key).second)
    return "";
  std::string comment, line = "#";
  std::istringstream words(found->second);
  for (std::string word; words >> word; line += ' ' + word)
    if (line.size() > 1 && line.size() + 1 + word.size() > kWidth) {
      comment += line + '\n';
      line = "#";
    }
  return line.size() > 1 ? comment + line + '\n' : comment;
}

void TomlDraft::write(std::string& text, const std::string& path, Explained& explained) const {
  // What follows the heading of another table belongs to that table, so values come first.
  for (const std::string& key : key_order_)
    if (const auto found = entries_.find(key); found != entries_.end() && !found->second.value.empty())
      text += explanation(key, explained) +
              (found->second.is_comment ? fmt::format("# {}: {}\n", toml_key(key), found->second.value)
                                        : fmt::format("{} = {}\n", toml_key(key), found->second.value));
  for (const std::string& key : key_order_) {
    const auto found = entries_.find(key);
    if (found == entries_.end() || !found->second.value.empty())
      continue;
    const std::string below = path.empty() ? toml_key(key) : path + '.' + toml_key(key);
    for (const std::unique_ptr<TomlDraft>& table : found->second.tables) {
      if (found->second.is_list)
        text += fmt::format("\n{}[[{}]]\n", explanation(key, explained), below);
      else if (table->has_values())
        text += fmt::format("\n{}[{}]\n", explanation(key, explained), below);
      table->write(text, below, explained);
    }
  }
}

void TomlDraft::add_lines(std::vector<Line>& lines, const std::string& path) const {
  for (const bool values : {true, false})
    for (const std::string& key : key_order_) {
      const auto found = entries_.find(key);
      if (found == entries_.end() || found->second.value.empty() == values)
        continue;
      const Entry& entry = found->second;
      const std::string below = path.empty() ? toml_key(key) : path + '.' + toml_key(key);
      if (values)
        lines.push_back({below, on_one_line(entry.value), on_one_line(entry.fallback)});
      for (std::size_t i = 0; i < entry.tables.size() && !values; ++i)
        entry.tables[i]->add_lines(lines, below + (entry.is_list ? fmt::format("[{}]", i) : ""));
    }
}

std::vector<TomlDraft::Line> TomlDraft::lines() const {
  std::vector<Line> lines;
  add_lines(lines, "");
  return lines;
}

std::string TomlDraft::text() const {
  std::string text;
  Explained explained;
  write(text, "", explained);
  return text.erase(0, text.find_first_not_of('\n'));
}

}  // namespace mpm
