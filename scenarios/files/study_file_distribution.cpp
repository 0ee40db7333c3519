#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

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

Distribution read_distribution(const TomlTable& table, std::string_view key, const NumberRule& rule) {
  const TomlTable inline_table = table.table(key, study_file_keys("DISTRIBUTION"));
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
