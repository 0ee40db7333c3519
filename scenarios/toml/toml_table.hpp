#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/error.hpp"
#include "scenarios/toml/toml_draft.hpp"

namespace mpm {

/// A view of one table of a TOML document that knows where it stands and which keys it may have.
///
/// It refuses what it cannot take with InputError "FILE:LINE: KEY: found ...; allowed: ...", where KEY is the
/// whole path ("controller.mv.u1.cost", places in lists counted from 0) and LINE the line of the value or,
/// for a missing key, of its table. A key that is looked up must be among the allowed ones. The document and
/// the file name must outlive the view.
///
/// What is read can be recorded: with a draft, the readers of values (toml_values.hpp) write every value that
/// they return into it, including defaults. The draft becomes the same document with its defaults written
/// out.
class TomlTable {
 public:
  /// The whole document. Errors: InputError for a key that is not in `allowed_keys`. `draft`, whose keys must
  /// be the allowed ones, takes what is recorded; it must outlive the view.
  TomlTable(const toml::table& document, const std::string& file_name, std::vector<std::string> allowed_keys,
            TomlDraft* draft = nullptr);

  /// False for the empty table that table_or_empty() gives for a missing key.
  bool is_there() const { return table_ != nullptr; }
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The value under `key`, null when there is none.
  const toml::node* find(std::string_view key) const;
  /// The value under `key`. Errors: InputError for a missing key; `allowed` says what it should be.
  const toml::node& require(std::string_view key, const std::string& allowed) const;
  /// The allowed keys that are there, in the order in which they are allowed.
  std::vector<std::string> present_keys() const;

  /// The table under `key`. Errors: InputError for a missing key, another type, or a key in the table that is
  /// not in `allowed_keys`.
  TomlTable table(std::string_view key, std::vector<std::string> allowed_keys) const;
  /// The same, or an empty table for a missing key.
  TomlTable table_or_empty(std::string_view key, std::vector<std::string> allowed_keys) const;
  /// The tables in the list under `key`, one or more. Errors: as table().
  std::vector<TomlTable> tables(std::string_view key, const std::vector<std::string>& allowed_keys) const;

  /// Records the value of a key that is in force, if there is a draft; the last one counts. For the readers
  /// of values, and for code that looks at a node itself.
  template <class Value>
  void record(std::string_view key, const Value& value) const {
    if (draft_ != nullptr)
      draft_->set(key, value);
  }

  /// Records the default of a key.
  template <class Value>
  void record_default(std::string_view key, const Value& value) const {
    if (draft_ != nullptr)
      draft_->set_default(key, value);
  }

  /// "FILE:LINE: KEY" of the value under `key`, or of this table for an empty `key`.
  std::string where(std::string_view key = {}) const;
  /// Throws the InputError for the value under `key`, or for this table for an empty `key`.
  [[noreturn]] void refuse(std::string_view key, const std::string& found, const std::string& allowed) const;
  /// Returns make(), with where(key) in front of the text of an InputError that comes from it.
  template <class Make>
  auto located(std::string_view key, Make make) const {
    try {
      return make();
    } catch (const InputError& error) {
      throw InputError(where(key) + ": " + error.what());
    }
  }

 private:
  TomlTable(const TomlTable& parent, const toml::table* table, std::string path,
            std::vector<std::string> allowed_keys, TomlDraft* draft);

  void refuse_unknown_keys() const;
  std::string path_of(std::string_view key) const;

  const toml::table* table_;  // null: an empty table replaces a missing one
  const std::string* file_name_;
  std::string path_;
  std::uint32_t line_;
  std::vector<std::string> allowed_keys_;
  TomlDraft* draft_;  // null: nothing is recorded
};

/// "'abc'", followed by the nearest of `names` if there is one: " (nearest: 'abd')". If there are more than
/// 40 names, such as those of findings, the nearest three follow.
std::string with_nearest(std::string_view name, const std::vector<std::string>& names);
/// All of `names`, or their number if there are more than 40.
std::string allowed_names(const std::vector<std::string>& names);

}  // namespace mpm
