#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/enum_words.hpp"
#include "scenarios/random/distribution.hpp"
#include "scenarios/toml/number_rule.hpp"
#include "scenarios/toml/toml_values.hpp"

// Each key of a table is declared once, as an OptionKey that ties it to a member of the options. The reader,
// the list of allowed keys, the comments of `mpmbench init` and the tables of the manual are made from it.

namespace mpm {

class TomlTable;
struct OptionKey;
using OptionKeys = std::vector<OptionKey>;

/// One key: what the manual says about it, in Markdown, and how it is read. Made by the functions of
/// mpm::key. It refers to the options that it is read into, which must live while it is read.
struct OptionKey {
  std::string name;  ///< empty: a check of what was read so far
  std::string type;
  std::string meaning;
  std::string unit = {};
  std::string fallback = {};  ///< the default
  std::string allowed = {};
  bool is_required = false;
  /// Reads the key from its table; none: the reader of the table does so.
  std::function<void(const TomlTable& table, const OptionKey& key)> reader = {};
  /// The keys of the table, or of each of the tables, under it; may be empty. They are asked for when the
  /// table is read, and may depend on what was read before.
  std::function<OptionKeys()> below = {};
  std::string suffix = {};  ///< of the name of that table: "[]" for a list, ".NAME" for one table a variable

  /// Makes the key required: it has no default.
  OptionKey required() &&;
  /// Gives the default in words.
  OptionKey otherwise(std::string words) &&;
  /// Says in words what is allowed.
  OptionKey allow(std::string words) &&;
  /// Adds words to what is allowed.
  OptionKey also(std::string words) &&;
  /// Sets the reader of a key of type option(), which is called if the key is there or required.
  OptionKey read(std::function<void(const TomlTable& table, const std::string& key)> how) &&;
  /// Adds a check of the table of the key, which is made before the key is read.
  OptionKey after(std::function<void(const TomlTable& table)> check) &&;
  /// Sets the keys of the tables under a key of type option().
  OptionKey with(std::string suffix_of_table, std::function<OptionKeys()> keys_below) &&;
};

/// The names of the keys, in their order.
std::vector<std::string> key_names(const OptionKeys& keys);

/// The same keys without their readers: for tables whose reader leaves some keys to other readers.
OptionKeys described(OptionKeys keys);

/// Reads every key, in their order, into the options. Errors: InputError.
void read_keys(const TomlTable& table, const OptionKeys& keys);

/// Calls `take` for each table of the list that is this key of a table. Errors: InputError, also for more
/// than `most`.
void read_list(const TomlTable& table, const OptionKey& key, std::size_t most,
               const std::function<void(const TomlTable& of_entry)>& take);

/// Reads options from a table, with the keys that the overload `keys(Options&)` declares.
template <class Options>
Options read_options(const TomlTable& table) {
  Options options;
  read_keys(table, keys(options));
  return options;
}

/// One table of a file with its keys. The name is its path: "[]" stands for each table of a list, "NAME" for
/// the name of a variable.
struct KeyTable {
  std::string name;
  OptionKeys keys;
};

/// The table of this name, and all below it.
std::vector<KeyTable> key_tables(const std::string& name, const OptionKeys& keys);

/// The table of the manual, in Markdown.
std::string manual_table(const OptionKeys& keys);

/// What the manual says about a key, as plain text on one line: meaning, unit, what is allowed.
std::string plain_meaning(const OptionKey& key);
/// The same for every key, by its name.
std::map<std::string, std::string> plain_meanings(const OptionKeys& keys);

}  // namespace mpm

// The kinds of keys. `meaning` and `unit` are for the manual; the present value is the default.
namespace mpm::key {

/// A key that is read by hand.
OptionKey option(std::string name, std::string type, std::string meaning, std::string unit = {});
OptionKey number(std::string name, double& value, const NumberRule& rule, std::string meaning,
                 std::string unit = {});
OptionKey flag(std::string name, bool& value, std::string meaning);
/// A text that is not empty; if the default is empty, it is none.
OptionKey text(std::string name, std::string& value, std::string meaning);
/// A text as read_name() takes it.
OptionKey name(std::string name, std::string& value, std::string meaning);
/// A whole number of at least `least`, which is read before it; say so in words with allow().
OptionKey whole_from(std::string name, int& value, const int& least, std::int64_t high, std::string meaning);
/// A list of whole numbers from `low` to `high`.
OptionKey wholes(std::string name, std::vector<int>& value, int low, int high, std::string meaning);
/// A list of texts; `allowed` says what they are.
OptionKey texts(std::string name, std::vector<std::string>& value, std::string allowed, std::string meaning);
/// [low, high] with low < high.
OptionKey band(std::string name, double& low, double& high, const NumberRule& rule, std::string meaning,
               std::string unit = {});
OptionKey distribution(std::string name, Distribution& value, const NumberRule& rule, std::string meaning,
                       std::string unit = {});
/// The keys of the inline table of a distribution.
OptionKeys distribution_keys();
/// A program and its arguments.
OptionKey command(std::string name, std::vector<std::string>& value, std::string meaning);
/// The names of some variables, of all that `names` gives when the key is read; `value` gets their indices.
OptionKey some_of(std::string name, std::vector<Eigen::Index>& value,
                  std::function<std::vector<std::string>()> names, std::string meaning);
/// The name of one of the variables; `value` gets its index.
OptionKey one_of(std::string name, Eigen::Index& value, std::function<std::vector<std::string>()> names,
                 std::string meaning);

/// [low, high] with low <= high, which may be infinite.
OptionKey limits(std::string name, NumberPair& value, std::string meaning, std::string unit);
/// Seconds that a program may take for an answer.
OptionKey time_limit(double& value, std::string meaning);

/// A table that may be missing: its keys then have their defaults.
OptionKey table(std::string name, std::function<OptionKeys()> below, std::string meaning);
/// A table that is read only when it is there.
OptionKey optional_table(std::string name, std::function<OptionKeys()> below, std::string meaning);
/// A table of relative frequencies in the order of `weights`. The table must have the first `required` names,
/// if it is there; other names that it leaves out have 0. `keys` have the names and meanings.
OptionKey weights(std::string name, OptionKeys keys, std::size_t required, double* weights,
                  std::string meaning);
/// Makes a check of what was read before it.
OptionKey check(std::function<void(const TomlTable& table)> what);

/// A whole number.
template <class Whole>
OptionKey whole(std::string name, Whole& value, std::int64_t low, std::int64_t high, std::string meaning,
                std::string unit = {}) {
  OptionKey made = option(std::move(name), "whole number", std::move(meaning), std::move(unit));
  made.fallback = std::to_string(value);
  made.allowed = std::to_string(low) + " to " + std::to_string(high);
  made.reader = [&value, low, high](const TomlTable& table, const OptionKey& key) {
    value = static_cast<Whole>(
        key.is_required ? read_whole(table, key.name, low, high)
                        : read_whole_or(table, key.name, low, high, static_cast<std::int64_t>(value)));
  };
  return made;
}

/// One of several words: those of the values of an enumeration, in their order.
template <class Value>
OptionKey choice(std::string name, Value& value, std::vector<std::string> words, std::string meaning) {
  OptionKey made = option(std::move(name), "text", std::move(meaning));
  made.fallback = "`\"" + words[static_cast<std::size_t>(value)] + "\"`";
  for (const std::string& word : words)
    made.allowed += (made.allowed.empty() ? "`\"" : ", `\"") + word + "\"`";
  made.reader = [&value, words = std::move(words)](const TomlTable& table, const OptionKey& key) {
    value = static_cast<Value>(read_one_of_or(table, key.name, words, static_cast<std::size_t>(value)));
  };
  return made;
}

/// The same for an enumeration that has kWords.
template <WordedEnum Value>
OptionKey choice(std::string name, Value& value, std::string meaning) {
  return choice(std::move(name), value, {kWords<Value>.begin(), kWords<Value>.end()}, std::move(meaning));
}

/// A list of tables, at most `most`. `below` ties the keys of a table to an Entry; `take` gets each Entry
/// that was read, in their order.
template <class Entry>
OptionKey list(std::string name, std::size_t most, std::function<OptionKeys(Entry&)> below,
               std::function<void(const TomlTable& table, Entry& entry)> take, std::string meaning) {
  OptionKey made = option(std::move(name), "list of tables", std::move(meaning));
  made.fallback = "none";
  made.suffix = "[]";
  // The keys refer to the entry, and so may those of tables below it.
  made.below = [below, entry = std::make_shared<Entry>()] { return below(*entry); };
  made.reader = [below, take = std::move(take), most](const TomlTable& table, const OptionKey& key) {
    read_list(table, key, most, [&](const TomlTable& of_entry) {
      Entry entry{};
      read_keys(of_entry, below(entry));
      take(of_entry, entry);
    });
  };
  return made;
}

}  // namespace mpm::key
