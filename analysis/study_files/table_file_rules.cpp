#include <set>
#include <string_view>
#include <tuple>

#include "analysis/study_files/table_file_parts.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

/// Refuses keys that have no meaning for this kind of rule, which would otherwise be ignored silently.
void refuse_idle_keys(const TomlTable& table, RuleKind kind) {
  const bool banded = kind == RuleKind::outside || kind == RuleKind::any_within;
  for (const char* key : {"threshold", "band", "yes", "no"}) {
    const bool idle = key == std::string_view("threshold") ? kind != RuleKind::any_above
                      : key == std::string_view("band")    ? !banded
                                                           : kind == RuleKind::rank;
    if (idle && table.has(key))
      table.refuse(key, "a key that this kind of rule does not use", "none");
  }
}

VerdictRule read_rule(const TomlTable& table, const std::vector<TableQuantity>& quantities) {
  VerdictRule rule;
  for (const std::size_t quantity : read_some_of(table, "quantities", quantity_names(quantities)))
    rule.quantities.push_back(quantities[quantity].name);
  rule.kind =
      static_cast<RuleKind>(read_one_of_or(table, "kind", {"outside", "any-above", "any-within", "rank"}, 0));
  refuse_idle_keys(table, rule.kind);
  if (rule.kind == RuleKind::any_above)
    rule.lower = read_number(table, "threshold", NumberRule::finite());
  if (rule.kind == RuleKind::outside || rule.kind == RuleKind::any_within) {
    table.require("band", "[low, high] with low < high");
    std::tie(rule.lower, rule.upper) = read_band_or(table, "band", NumberRule::finite(), {});
  }
  if (rule.kind != RuleKind::rank) {
    rule.yes = read_text(table, "yes");
    rule.no = read_text(table, "no");
  }
  rule.source = read_text(table, "source");
  return rule;
}

}  // namespace

std::vector<VerdictRule> read_table_rules(const TomlTable& document,
                                          const std::vector<TableQuantity>& quantities) {
  std::vector<VerdictRule> rules;
  std::set<std::string> ruled;
  if (!document.has("rule"))
    return rules;
  for (const TomlTable& table :
       document.tables("rule", {"quantities", "kind", "threshold", "band", "yes", "no", "source"})) {
    rules.push_back(read_rule(table, quantities));
    for (const std::string& quantity : rules.back().quantities)
      if (!ruled.insert(quantity).second)
        table.refuse("quantities", in_quotes(quantity) + ", which has a rule already", "one rule a quantity");
  }
  return rules;
}

}  // namespace mpm
