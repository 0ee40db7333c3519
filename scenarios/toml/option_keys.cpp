#include "scenarios/toml/option_keys.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/toml/toml_literal.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

/// The text without backquotes, and with the text of each link in place of the link.
std::string plain(const std::string& markdown) {
  std::string text;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    const std::size_t closed = markdown.find("](", i);
    if (markdown[i] == '[' && closed != std::string::npos && markdown.find(']', i) == closed) {
      text += plain(markdown.substr(i + 1, closed - i - 1));
      i = markdown.find(')', closed);
    } else if (markdown[i] != '`') {
      text += markdown[i];
    }
  }
  return text;
}

/// "> 0", "0 to below 1", "between 0 and 1"
std::string manual_text(const NumberRule& rule) {
  if (std::isinf(rule.low) && std::isinf(rule.high))
    return "finite";
  if (std::isinf(rule.high))
    return fmt::format("{} {}", rule.low_included ? ">=" : ">", rule.low);
  if (!rule.low_included && !rule.high_included)
    return fmt::format("between {} and {}", rule.low, rule.high);
  return fmt::format("{}{} {}{}", rule.low_included ? "" : "above ", rule.low,
                     rule.high_included ? (rule.low_included ? "to " : "and at most ") : "to below ",
                     rule.high);
}

constexpr std::size_t kLongestList = 100;  // of whole numbers

std::string in_backquotes(const std::string& text) {
  return '`' + text + '`';
}

}  // namespace

OptionKey OptionKey::required() && {
  is_required = true;
  fallback = "required";
  return std::move(*this);
}

OptionKey OptionKey::otherwise(std::string words) && {
  fallback = std::move(words);
  return std::move(*this);
}

OptionKey OptionKey::allow(std::string words) && {
  allowed = std::move(words);
  return std::move(*this);
}

OptionKey OptionKey::also(std::string words) && {
  allowed += "; " + words;
  return std::move(*this);
}

OptionKey OptionKey::read(std::function<void(const TomlTable&, const std::string&)> how) && {
  reader = [how = std::move(how)](const TomlTable& table, const OptionKey& key) {
    if (key.is_required || table.has(key.name))
      how(table, key.name);
  };
  return std::move(*this);
}

OptionKey OptionKey::after(std::function<void(const TomlTable&)> check) && {
  reader = [check = std::move(check), then = std::move(reader)](const TomlTable& table,
                                                                const OptionKey& key) {
    check(table);
    then(table, key);
  };
  return std::move(*this);
}

OptionKey OptionKey::with(std::string suffix_of_table, std::function<OptionKeys()> keys_below) && {
  suffix = std::move(suffix_of_table);
  below = std::move(keys_below);
  return std::move(*this);
}

std::vector<std::string> key_names(const OptionKeys& keys) {
  std::vector<std::string> names;
  for (const OptionKey& key : keys)
    if (!key.name.empty())
      names.push_back(key.name);
  return names;
}

OptionKeys described(OptionKeys keys) {
  for (OptionKey& key : keys)
    key.reader = nullptr;
  return keys;
}

void read_keys(const TomlTable& table, const OptionKeys& keys) {
  for (const OptionKey& key : keys)
    if (key.reader)
      key.reader(table, key);
}

void read_list(const TomlTable& table, const OptionKey& key, std::size_t most,
               const std::function<void(const TomlTable&)>& take) {
  if (!key.is_required && !table.has(key.name))
    return;
  const std::vector<TomlTable> tables = table.tables(key.name, key_names(key.below()));
  if (tables.size() > most)
    table.refuse(key.name, "a list of " + std::to_string(tables.size()), "at most " + std::to_string(most));
  for (const TomlTable& of_entry : tables)
    take(of_entry);
}

std::vector<KeyTable> key_tables(const std::string& name, const OptionKeys& keys) {
  std::vector<KeyTable> tables{{name, keys}};
  for (const OptionKey& key : keys)
    if (key.below)
      for (KeyTable& table :
           key_tables((name.empty() ? "" : name + '.') + key.name + key.suffix, key.below()))
        tables.push_back(std::move(table));
  return tables;
}

std::string manual_table(const OptionKeys& keys) {
  struct Column {
    const char* head;
    std::string OptionKey::*cell;
  };
  std::string head = "| key |", line = "|---|";
  std::vector<std::string> rows;
  for (const OptionKey& key : keys)
    rows.push_back(fmt::format("| `{}` |", key.name));
  for (const auto& [title, cell] :
       {Column{"type", &OptionKey::type}, Column{"unit", &OptionKey::unit},
        Column{"default", &OptionKey::fallback}, Column{"allowed", &OptionKey::allowed},
        Column{"meaning", &OptionKey::meaning}}) {
    const auto has_cell = [member = cell](const OptionKey& key) { return !(key.*member).empty(); };
    if (std::none_of(keys.begin(), keys.end(), has_cell))
      continue;
    head += fmt::format(" {} |", title);
    line += "---|";
    for (std::size_t i = 0; i < keys.size(); ++i)
      rows[i] += (keys[i].*cell).empty() ? " |" : fmt::format(" {} |", keys[i].*cell);
  }
  std::string text = head + '\n' + line + '\n';
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!keys[i].name.empty())
      text += rows[i] + '\n';
  return text;
}

std::string plain_meaning(const OptionKey& key) {
  std::string text = key.meaning;
  if (!key.unit.empty())
    text += fmt::format("{}[{}]", text.empty() ? "" : " ", key.unit);
  if (!key.allowed.empty())
    text += fmt::format("{}allowed: {}", text.empty() ? "" : "; ", key.allowed);
  return plain(text);
}

std::map<std::string, std::string> plain_meanings(const OptionKeys& keys) {
  std::map<std::string, std::string> meanings;
  for (const OptionKey& key : keys)
    meanings.emplace(key.name, plain_meaning(key));
  return meanings;
}

namespace key {

OptionKey option(std::string name, std::string type, std::string meaning, std::string unit) {
  return {.name = std::move(name),
          .type = std::move(type),
          .meaning = std::move(meaning),
          .unit = std::move(unit)};
}

OptionKey number(std::string name, double& value, const NumberRule& rule, std::string meaning,
                 std::string unit) {
  OptionKey made = option(std::move(name), "number", std::move(meaning), std::move(unit));
  made.fallback = fmt::to_string(value);
  if (const std::size_t exponent = made.fallback.find("e-0"); exponent != std::string::npos)
    made.fallback.erase(exponent + 2, 1);
  made.allowed = manual_text(rule);
  made.reader = [&value, rule](const TomlTable& table, const OptionKey& key) {
    value =
        key.is_required ? read_number(table, key.name, rule) : read_number_or(table, key.name, rule, value);
  };
  return made;
}

OptionKey flag(std::string name, bool& value, std::string meaning) {
  OptionKey made = option(std::move(name), "flag", std::move(meaning));
  made.fallback = value ? "true" : "false";
  made.reader = [&value](const TomlTable& table, const OptionKey& key) {
    value = read_flag_or(table, key.name, value);
  };
  return made;
}

OptionKey text(std::string name, std::string& value, std::string meaning) {
  OptionKey made = option(std::move(name), "text", std::move(meaning));
  made.fallback = value.empty() ? "none" : in_backquotes(toml_literal(value));
  made.allowed = "not empty";
  made.reader = [&value](const TomlTable& table, const OptionKey& key) {
    value = key.is_required ? read_text(table, key.name) : read_text_or(table, key.name, value);
  };
  return made;
}

OptionKey name(std::string name, std::string& value, std::string meaning) {
  return option(std::move(name), "text", std::move(meaning))
      .required()
      .allow("1 to 64 letters, digits, `_`, `-`")
      .read([&value](const TomlTable& table, const std::string& key) { value = read_name(table, key); });
}

OptionKey whole_from(std::string name, int& value, const int& least, std::int64_t high, std::string meaning) {
  OptionKey made = whole(std::move(name), value, 0, high, std::move(meaning));
  made.reader = [&value, &least, high](const TomlTable& table, const OptionKey& key) {
    value = static_cast<int>(read_whole_or(table, key.name, least, high, std::max(least, value)));
  };
  return made;
}

OptionKey wholes(std::string name, std::vector<int>& value, int low, int high, std::string meaning) {
  OptionKey made = option(std::move(name), "list of whole numbers", std::move(meaning));
  made.fallback = in_backquotes(toml_literal(value));
  made.allowed = fmt::format("{} to {} each", low, high);
  made.reader = [&value, low, high](const TomlTable& table, const OptionKey& key) {
    const NumberRule rule{.low = static_cast<double>(low),
                          .high = static_cast<double>(high),
                          .low_included = true,
                          .high_included = true};
    if (table.has(key.name)) {
      value.clear();
      for (const double number : read_numbers(table, key.name, rule, kLongestList)) {
        if (number != std::floor(number))
          table.refuse(key.name, fmt::format("{}", number), "whole numbers");
        value.push_back(static_cast<int>(number));
      }
    }
    table.record(key.name, value);  // as whole numbers
  };
  return made;
}

OptionKey texts(std::string name, std::vector<std::string>& value, std::string allowed, std::string meaning) {
  OptionKey made = option(std::move(name), "list of texts", std::move(meaning));
  made.fallback = value.empty() ? "none" : in_backquotes(toml_literal(value));
  made.reader = [&value, allowed = std::move(allowed)](const TomlTable& table, const OptionKey& key) {
    if (!value.empty() || table.has(key.name))
      value = read_texts_or(table, key.name, allowed, value);
  };
  return made;
}

OptionKey band(std::string name, double& low, double& high, const NumberRule& rule, std::string meaning,
               std::string unit) {
  OptionKey made = option(std::move(name), "list of 2 numbers", std::move(meaning), std::move(unit));
  made.fallback = in_backquotes(toml_literal(std::pair(low, high)));
  made.allowed = fmt::format("{} < low < high{}", rule.low,
                             std::isinf(rule.high) ? "" : fmt::format(" <= {}", rule.high));
  made.reader = [&low, &high, rule](const TomlTable& table, const OptionKey& key) {
    std::tie(low, high) = read_band_or(table, key.name, rule, {low, high});
  };
  return made;
}

OptionKey distribution(std::string name, Distribution& value, const NumberRule& rule, std::string meaning,
                       std::string unit) {
  OptionKey made = option(std::move(name), "distribution", std::move(meaning), std::move(unit));
  made.fallback = in_backquotes(toml_literal(value));
  made.allowed = "draws " + manual_text(rule);
  made.reader = [&value, rule](const TomlTable& table, const OptionKey& key) {
    value = key.is_required ? read_distribution(table, key.name, rule)
                            : read_distribution_or(table, key.name, rule, value);
  };
  return made;
}

OptionKeys distribution_keys() {
  return {
      option("constant", "number", "always this value").allow("finite"),
      option("uniform", "list of 2 numbers", "every value from low to high is equally likely")
          .allow("low < high"),
      option("log_uniform", "list of 2 numbers", "every ratio equally likely").allow("0 < low < high"),
      option("normal", "list of 2 numbers", "mean and standard deviation; only where every number is allowed")
          .allow("standard deviation > 0")};
}

OptionKey command(std::string name, std::vector<std::string>& value, std::string meaning) {
  return option(std::move(name), "list of texts", std::move(meaning))
      .required()
      .allow("one or more")
      .read([&value](const TomlTable& table, const std::string& key) { value = read_command(table, key); });
}

OptionKey some_of(std::string name, std::vector<Eigen::Index>& value,
                  std::function<std::vector<std::string>()> names, std::string meaning) {
  return option(std::move(name), "list of texts", std::move(meaning))
      .read([&value, names = std::move(names)](const TomlTable& table, const std::string& key) {
        const std::vector<std::size_t> places = read_some_of(table, key, names());
        value.assign(places.begin(), places.end());
      });
}

OptionKey one_of(std::string name, Eigen::Index& value, std::function<std::vector<std::string>()> names,
                 std::string meaning) {
  return option(std::move(name), "text", std::move(meaning))
      .required()
      .read([&value, names = std::move(names)](const TomlTable& table, const std::string& key) {
        value = static_cast<Eigen::Index>(read_one_of(table, key, names()));
      });
}

OptionKey limits(std::string name, NumberPair& value, std::string meaning, std::string unit) {
  return option(std::move(name), "list of 2 numbers", std::move(meaning), std::move(unit))
      .allow("low <= high; `-inf` and `inf` for no limit")
      .required()
      .read([&value](const TomlTable& table, const std::string& key) { value = read_limits(table, key); });
}

OptionKey time_limit(double& value, std::string meaning) {
  OptionKey made = number("time_limit", value, NumberRule::positive(), std::move(meaning));
  made.allowed += ", at most 86400";
  made.reader = [&value](const TomlTable& table, const OptionKey& key) {
    value = read_time_limit_or(table, key.name, value);
  };
  return made;
}

OptionKey table(std::string name, std::function<OptionKeys()> below, std::string meaning) {
  OptionKey made = option(std::move(name), "table", std::move(meaning));
  made.fallback = "all defaults";
  made.reader = [](const TomlTable& table, const OptionKey& key) {
    const OptionKeys keys = key.below();
    read_keys(key.is_required ? table.table(key.name, key_names(keys))
                              : table.table_or_empty(key.name, key_names(keys)),
              keys);
  };
  made.below = std::move(below);
  return made;
}

OptionKey optional_table(std::string name, std::function<OptionKeys()> below, std::string meaning) {
  OptionKey made = table(std::move(name), std::move(below), std::move(meaning)).otherwise("none");
  made.reader = [](const TomlTable& table, const OptionKey& key) {
    const OptionKeys keys = key.below();
    if (table.has(key.name))
      read_keys(table.table(key.name, key_names(keys)), keys);
  };
  return made;
}

OptionKey weights(std::string name, OptionKeys keys, std::size_t required, double* weights,
                  std::string meaning) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i].type = "number";
    keys[i].allowed = ">= 0";
    keys[i].fallback = i < required ? "required" : "0";
    if (weights[i] != 0.0)
      keys[i].fallback += fmt::format("; {} without the table", weights[i]);
    keys[i].reader = [&weight = weights[i], required = i < required](const TomlTable& table,
                                                                     const OptionKey& key) {
      const NumberRule rule = NumberRule::at_least(0);
      weight = required && table.is_there()
                   ? read_number(table, key.name, rule)
                   : read_number_or(table, key.name, rule, table.is_there() ? 0.0 : weight);
    };
  }
  return table(
             std::move(name), [keys = std::move(keys)] { return keys; }, std::move(meaning))
      .allow("not all 0");
}

OptionKey check(std::function<void(const TomlTable&)> what) {
  OptionKey made;
  made.reader = [what = std::move(what)](const TomlTable& table, const OptionKey&) { what(table); };
  return made;
}

}  // namespace key
}  // namespace mpm
