#include "scenarios/toml/toml_values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/non_finite.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kLongestName = 64;

template <class Value>
Value recorded(const TomlTable& table, std::string_view key, Value value) {
  table.record(key, value);
  return value;
}

/// The value of a key that may be missing: what `read` reads, or the default.
template <class Value, class Read>
Value read_or(const TomlTable& table, std::string_view key, const Value& fallback, Read read) {
  table.record_default(key, fallback);
  return table.has(key) ? read() : recorded(table, key, fallback);
}

/// The number in a node; NaN, which no rule allows, if it has none.
double number_in(const toml::node& node) {
  return node.value<double>().value_or(kNaN);
}

std::string describe_pair(double low, double high) {
  return fmt::format("[{}, {}]", low, high);
}

/// The two numbers of the list under `key`; refuses anything else.
NumberPair raw_pair(const TomlTable& table, std::string_view key, const std::string& allowed) {
  const toml::node& node = table.require(key, allowed);
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 2) {
    table.refuse(key, describe(node), allowed);
  }
  for (const toml::node& element : *list) {
    if (!element.is_number()) {
      table.refuse(key, describe_no_number(element) + " in the list", allowed);
    }
  }
  return {number_in((*list)[0]), number_in((*list)[1])};
}

/// The position of the text `node`, which stands under `key`, in `names`.
std::size_t position_of(const TomlTable& table, std::string_view key, const toml::node& node,
                        const std::vector<std::string>& names) {
  const std::string allowed = allowed_names(names);
  const toml::value<std::string>* text = node.as_string();
  if (text == nullptr) {
    table.refuse(key, describe(node), allowed);
  }
  const auto place = std::find(names.begin(), names.end(), text->get());
  if (place == names.end()) {
    table.refuse(key, with_nearest(text->get(), names), allowed);
  }
  return static_cast<std::size_t>(place - names.begin());
}

Distribution make_distribution(const TomlTable& inline_table, const std::string& kind) {
  if (kind == "constant") {
    return Distribution::constant(read_number(inline_table, kind, NumberRule::finite()));
  }
  const bool normal = kind == "normal";
  const NumberPair pair = read_pair(
      inline_table, kind,
      normal ? "[mean, standard deviation], two finite numbers" : "[low, high], two finite numbers");
  return inline_table.located(kind, [&] {
    if (normal) {
      return Distribution::normal(pair.first, pair.second);
    }
    return kind == "uniform" ? Distribution::uniform(pair.first, pair.second)
                             : Distribution::log_uniform(pair.first, pair.second);
  });
}

}  // namespace

double read_number(const TomlTable& table, std::string_view key, const NumberRule& rule) {
  const toml::node& node = table.require(key, rule.text());
  const double value = number_in(node);
  if (!node.is_number() || !rule.contains(value)) {
    table.refuse(key, describe_no_number(node), rule.text());
  }
  return recorded(table, key, value);
}

double read_number_or(const TomlTable& table, std::string_view key, const NumberRule& rule, double fallback) {
  return read_or(table, key, fallback, [&] { return read_number(table, key, rule); });
}

std::int64_t read_whole(const TomlTable& table, std::string_view key, std::int64_t low, std::int64_t high) {
  const std::string allowed = fmt::format("a whole number from {} to {}", low, high);
  const toml::node& node = table.require(key, allowed);
  const toml::value<std::int64_t>* value = node.as_integer();
  if (value == nullptr || value->get() < low || value->get() > high) {
    table.refuse(key, describe_no_number(node), allowed);
  }
  return recorded(table, key, value->get());
}

std::int64_t read_whole_or(const TomlTable& table, std::string_view key, std::int64_t low, std::int64_t high,
                           std::int64_t fallback) {
  return read_or(table, key, fallback, [&] { return read_whole(table, key, low, high); });
}

bool read_flag_or(const TomlTable& table, std::string_view key, bool fallback) {
  return read_or(table, key, fallback, [&] {
    const toml::value<bool>* flag = table.find(key)->as_boolean();
    if (flag == nullptr)
      table.refuse(key, describe(*table.find(key)), "true or false");
    return recorded(table, key, flag->get());
  });
}

std::string read_text(const TomlTable& table, std::string_view key) {
  const std::string allowed = "a text that is not empty";
  const toml::node& node = table.require(key, allowed);
  const toml::value<std::string>* text = node.as_string();
  if (text == nullptr || text->get().empty()) {
    table.refuse(key, describe(node), allowed);
  }
  return recorded(table, key, text->get());
}

std::string read_text_or(const TomlTable& table, std::string_view key, const std::string& fallback) {
  if (fallback.empty())
    return table.has(key) ? read_text(table, key) : fallback;
  return read_or(table, key, fallback, [&] { return read_text(table, key); });
}

bool is_name(const std::string& text) {
  const auto may_stand_in_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !text.empty() && text.size() <= kLongestName &&
         std::all_of(text.begin(), text.end(), may_stand_in_name);
}

std::string read_name(const TomlTable& table, std::string_view key) {
  const std::string allowed = fmt::format("1 to {} letters, digits, '_' and '-'", kLongestName);
  const toml::node& node = table.require(key, allowed);
  const toml::value<std::string>* text = node.as_string();
  if (text == nullptr || !is_name(text->get())) {
    table.refuse(key, describe(node), allowed);
  }
  return recorded(table, key, text->get());
}

std::size_t read_one_of(const TomlTable& table, std::string_view key, const std::vector<std::string>& names) {
  const toml::node& node = table.require(key, fmt::format("{}", fmt::join(names, ", ")));
  const std::size_t position = position_of(table, key, node, names);
  table.record(key, names[position]);
  return position;
}

std::size_t read_one_of_or(const TomlTable& table, std::string_view key,
                           const std::vector<std::string>& names, std::size_t fallback) {
  table.record_default(key, names[fallback]);
  table.record(key, names[fallback]);
  return table.has(key) ? read_one_of(table, key, names) : fallback;
}

std::vector<std::size_t> read_some_of(const TomlTable& table, std::string_view key,
                                      const std::vector<std::string>& names) {
  const std::string allowed = fmt::format("a list of one or more of {}", fmt::join(names, ", "));
  const toml::node& node = table.require(key, allowed);
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty()) {
    table.refuse(key, describe(node), allowed);
  }
  std::vector<std::size_t> positions;
  std::vector<std::string> chosen;
  for (const toml::node& element : *list) {
    const std::size_t position = position_of(table, key, element, names);
    if (std::find(positions.begin(), positions.end(), position) != positions.end()) {
      table.refuse(key, fmt::format("{} twice", in_quotes(names[position])), "every name once");
    }
    positions.push_back(position);
    chosen.push_back(names[position]);
  }
  table.record(key, chosen);
  return positions;
}

std::vector<std::string> read_texts_or(const TomlTable& table, std::string_view key,
                                       const std::string& allowed, const std::vector<std::string>& fallback) {
  table.record_default(key, fallback);
  if (!table.has(key))
    return recorded(table, key, fallback);
  const std::string list_of = fmt::format("a list of one or more {}, each once", allowed);
  const toml::node& node = table.require(key, list_of);
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty())
    table.refuse(key, describe(node), list_of);
  std::vector<std::string> texts;
  for (const toml::node& element : *list) {
    const toml::value<std::string>* text = element.as_string();
    if (text == nullptr || text->get().empty())
      table.refuse(key, describe(element), list_of);
    if (std::find(texts.begin(), texts.end(), text->get()) != texts.end())
      table.refuse(key, fmt::format("{} twice", in_quotes(text->get())), list_of);
    texts.push_back(text->get());
  }
  table.record(key, texts);
  return texts;
}

std::vector<std::string> read_command(const TomlTable& table, std::string_view key) {
  const std::string allowed = "a list of texts: the program and its arguments";
  const toml::node& node = table.require(key, allowed);
  std::vector<std::string> words;
  if (const toml::array* const list = node.as_array())
    for (const toml::node& word : *list) {
      if (!word.is_string())
        table.refuse(key, describe(word), allowed);
      words.push_back(word.as_string()->get());
    }
  if (words.empty() || words.front().empty())
    table.refuse(key, describe(node), allowed);
  table.record(key, words);
  return words;
}

double read_time_limit_or(const TomlTable& table, std::string_view key, double fallback) {
  constexpr double kDay = 86400.0;
  const double seconds = read_number_or(table, key, NumberRule::positive(), fallback);
  if (seconds > kDay)
    table.refuse(key, fmt::to_string(seconds), fmt::format("at most {} s", kDay));
  return seconds;
}

Eigen::VectorXd read_numbers(const TomlTable& table, std::string_view key, const NumberRule& rule,
                             std::size_t longest) {
  const std::string allowed = fmt::format("a list of 1 to {}, each {}", longest, rule.text());
  const toml::node& node = table.require(key, allowed);
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() || list->size() > longest) {
    table.refuse(key, describe(node), allowed);
  }
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(list->size()));
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    const toml::node& element = (*list)[static_cast<std::size_t>(i)];
    numbers(i) = number_in(element);
    if (!element.is_number() || !rule.contains(numbers(i))) {
      table.refuse(key, describe_no_number(element) + " in the list", allowed);
    }
  }
  return recorded(table, key, numbers);
}

NumberPair read_pair(const TomlTable& table, std::string_view key, const std::string& allowed) {
  const NumberPair pair = raw_pair(table, key, allowed);
  if (!std::isfinite(pair.first) || !std::isfinite(pair.second)) {
    table.refuse(key, describe_pair(pair.first, pair.second), allowed);
  }
  return recorded(table, key, pair);
}

NumberPair read_band_or(const TomlTable& table, std::string_view key, const NumberRule& rule,
                        const NumberPair& fallback) {
  table.record_default(key, fallback);
  if (!table.has(key)) {
    return recorded(table, key, fallback);
  }
  const std::string allowed = fmt::format("[low, high] with low < high, each {}", rule.text());
  const NumberPair band = read_pair(table, key, allowed);
  if (!(band.first < band.second) || !rule.contains(band.first) || !rule.contains(band.second)) {
    table.refuse(key, describe_pair(band.first, band.second), allowed);
  }
  return band;
}

NumberPair read_limits(const TomlTable& table, std::string_view key) {
  const std::string allowed = "[low, high] with low <= high; -inf and inf for no limit";
  const NumberPair limits = raw_pair(table, key, allowed);
  const auto [low, high] = limits;
  if (!(low <= high) || low == kInfinity || high == -kInfinity) {
    table.refuse(key, describe_pair(low, high), allowed);
  }
  return recorded(table, key, limits);
}

Distribution read_distribution(const TomlTable& table, std::string_view key, const NumberRule& rule) {
  const TomlTable inline_table = table.table(key, {"constant", "uniform", "log_uniform", "normal"});
  const std::vector<std::string> kinds = inline_table.present_keys();
  if (kinds.size() != 1) {
    table.refuse(key, fmt::format("a table with {} keys", kinds.size()),
                 "one of {constant = x}, {uniform = [low, high]}, {log_uniform = [low, high]}, "
                 "{normal = [mean, standard deviation]}");
  }
  const Distribution distribution = make_distribution(inline_table, kinds.front());
  if (!rule.contains_support(distribution.minimum(), distribution.maximum())) {
    table.refuse(key, fmt::format("draws from {} to {}", distribution.minimum(), distribution.maximum()),
                 fmt::format("a distribution whose every draw is {}", rule.text()));
  }
  table.record(key, distribution);
  return distribution;
}

Distribution read_distribution_or(const TomlTable& table, std::string_view key, const NumberRule& rule,
                                  const Distribution& fallback) {
  table.record_default(key, fallback);
  if (table.has(key))
    return read_distribution(table, key, rule);
  table.record(key, fallback);
  return fallback;
}

}  // namespace mpm
