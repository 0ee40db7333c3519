#include "scenarios/toml/toml_table.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/toml/nearest_name.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kReadAtOnce = 40;  // in a longer list a reader does not find the right name

std::uint32_t line_of(const toml::node* node, std::uint32_t fallback) {
  return node != nullptr && node->source().begin.line > 0 ? node->source().begin.line : fallback;
}

}  // namespace

TomlTable::TomlTable(const toml::table& document, const std::string& file_name,
                     std::vector<std::string> allowed_keys, TomlDraft* draft)
    : table_(&document),
      file_name_(&file_name),
      line_(1),
      allowed_keys_(std::move(allowed_keys)),
      draft_(draft) {
  refuse_unknown_keys();
}

TomlTable::TomlTable(const TomlTable& parent, const toml::table* table, std::string path,
                     std::vector<std::string> allowed_keys, TomlDraft* draft)
    : table_(table),
      file_name_(parent.file_name_),
      path_(std::move(path)),
      line_(line_of(table, parent.line_)),
      allowed_keys_(std::move(allowed_keys)),
      draft_(draft) {
  refuse_unknown_keys();
}

/// Refuses the first unknown key in the file.
void TomlTable::refuse_unknown_keys() const {
  if (table_ == nullptr) {
    return;
  }
  const toml::key* first = nullptr;
  for (const auto& [key, value] : *table_) {
    const bool known =
        std::find(allowed_keys_.begin(), allowed_keys_.end(), key.str()) != allowed_keys_.end();
    if (!known && (first == nullptr || key.source().begin < first->source().begin)) {
      first = &key;
    }
  }
  if (first != nullptr) {
    throw InputError(fmt::format("{}:{}: {}", *file_name_, first->source().begin.line,
                                 path_.empty() ? "top level" : path_),
                     "unknown key " + with_nearest(first->str(), allowed_keys_),
                     fmt::format("{}", fmt::join(allowed_keys_, ", ")));
  }
}

const toml::node* TomlTable::find(std::string_view key) const {
  assert(std::find(allowed_keys_.begin(), allowed_keys_.end(), key) != allowed_keys_.end());
  return table_ == nullptr ? nullptr : table_->get(key);
}

const toml::node& TomlTable::require(std::string_view key, const std::string& allowed) const {
  const toml::node* node = find(key);
  if (node == nullptr) {
    refuse(key, "nothing", allowed);
  }
  return *node;
}

std::vector<std::string> TomlTable::present_keys() const {
  std::vector<std::string> keys;
  std::copy_if(allowed_keys_.begin(), allowed_keys_.end(), std::back_inserter(keys),
               [this](const std::string& key) { return has(key); });
  return keys;
}

TomlTable TomlTable::table(std::string_view key, std::vector<std::string> allowed_keys) const {
  require(key, "a table");
  return table_or_empty(key, std::move(allowed_keys));
}

TomlTable TomlTable::table_or_empty(std::string_view key, std::vector<std::string> allowed_keys) const {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) {
    refuse(key, describe(*node), "a table");
  }
  TomlDraft* const draft = draft_ == nullptr ? nullptr : &draft_->table(key, allowed_keys);
  return {*this, node == nullptr ? nullptr : node->as_table(), path_of(key), std::move(allowed_keys), draft};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key,
                                         const std::vector<std::string>& allowed_keys) const {
  const std::string allowed = "a list of tables, one or more";
  const toml::node& node = require(key, allowed);
  if (!node.is_array_of_tables()) {
    refuse(key, describe(node), allowed);
  }
  std::vector<TomlTable> tables;
  for (const toml::node& element : *node.as_array()) {
    std::string path = fmt::format("{}[{}]", path_of(key), tables.size());
    TomlDraft* const draft =
        draft_ == nullptr ? nullptr : &draft_->table_in_list(key, tables.size(), allowed_keys);
    tables.push_back(TomlTable(*this, element.as_table(), std::move(path), allowed_keys, draft));
  }
  return tables;
}

std::string TomlTable::path_of(std::string_view key) const {
  if (path_.empty() || key.empty()) {
    return path_ + std::string(key);
  }
  return fmt::format("{}.{}", path_, key);
}

std::string TomlTable::where(std::string_view key) const {
  const std::uint32_t line = key.empty() ? line_ : line_of(find(key), line_);
  return fmt::format("{}:{}: {}", *file_name_, line, path_of(key));
}

void TomlTable::refuse(std::string_view key, const std::string& found, const std::string& allowed) const {
  throw InputError(where(key), found, allowed);
}

std::string allowed_names(const std::vector<std::string>& names) {
  return names.size() > kReadAtOnce ? fmt::format("one of {} names", names.size())
                                    : fmt::format("{}", fmt::join(names, ", "));
}

std::string with_nearest(std::string_view name, const std::vector<std::string>& names) {
  std::vector<std::string> nearest = nearest_names(name, names, names.size() > kReadAtOnce ? 3 : 1);
  for (std::string& one : nearest)
    one = fmt::format("'{}'", one);
  return nearest.empty() ? in_quotes(name)
                         : fmt::format("{} (nearest: {})", in_quotes(name), fmt::join(nearest, ", "));
}

}  // namespace mpm
