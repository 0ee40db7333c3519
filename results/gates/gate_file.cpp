#include "results/gates/gate_file.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();

const std::vector<std::string>& gate_file_keys(std::string_view table) {
  const auto& tables = gate_file_tables();
  return std::find_if(tables.begin(), tables.end(), [&](const auto& entry) { return entry.name == table; })
      ->keys;
}

/// Limits of a share are shares: a limit of 95 on it was meant as a percentage, and no result would ever show
/// that it is wrong.
NumberRule limit_rule(const Finding& finding) {
  return finding.is_share() ? NumberRule{.low = 0, .high = 1, .low_included = true, .high_included = true}
                            : NumberRule::finite();
}

/// A gate on a method that has not assessed the loops gets its own message: a list of other numbers would not
/// help.
void require_assessed(const TomlTable& table, const std::vector<Finding>& findings) {
  if (!table.has("aggregate"))
    return;
  const toml::value<std::string>* name = table.require("aggregate", "").as_string();
  if (name == nullptr || find_finding(findings, name->get()) != nullptr)
    return;
  for (const AssessmentMethodInfo& method : assessment_methods())
    if (name->get().starts_with(fmt::format("compare.{}.", method.name)) &&
        std::none_of(findings.begin(), findings.end(),
                     [&](const Finding& f) { return f.method == method.name; }))
      table.refuse(
          "aggregate", fmt::format("'{}', and the method has not assessed the archive", name->get()),
          fmt::format("this number for an archive that `mpmbench compare ARCHIVE --methods {} -o OUT.h5` has "
                      "written",
                      method.name));
}

Gate read_gate(const TomlTable& table, const std::vector<Finding>& findings) {
  require_assessed(table, findings);
  std::vector<std::string> names;
  for (const Finding& finding : findings)
    names.push_back(finding.name);
  const Finding& finding = findings[read_one_of(table, "aggregate", names)];
  Gate gate;
  gate.name = finding.name;
  const NumberRule rule = limit_rule(finding);
  gate.minimum = read_number_or(table, "minimum", rule, gate.minimum);
  gate.maximum = read_number_or(table, "maximum", rule, gate.maximum);
  if (!table.has("minimum") && !table.has("maximum"))
    table.refuse("", "no limit", "minimum, maximum or both");
  if (gate.minimum > gate.maximum)
    table.refuse("maximum", fmt::format("{}", gate.maximum),
                 fmt::format("a number >= the minimum, {}", gate.minimum));
  gate.with_confidence = read_flag_or(table, "with_confidence", gate.with_confidence);
  if (gate.with_confidence && !finding.has_interval)
    table.refuse("with_confidence", "true", fmt::format("false: '{}' has no interval", gate.name));
  gate.minimum_count = read_whole_or(table, "minimum_count", 1, kMaxCount, gate.minimum_count);
  gate.reason = read_text_or(table, "reason", "");
  return gate;
}

BaselineLimits read_baseline(const TomlTable& document, const std::filesystem::path& folder) {
  const TomlTable table = document.table("baseline", gate_file_keys("baseline"));
  BaselineLimits limits;
  limits.archive = folder / read_text(table, "archive");  // an absolute path stands alone
  limits.significance = read_number_or(table, "significance", NumberRule::inside(0, 1), limits.significance);
  if (table.has("maximum_lost"))
    limits.maximum_lost = read_whole(table, "maximum_lost", 0, kMaxCount);
  return limits;
}

}  // namespace

const std::vector<StudyFileTable>& gate_file_tables() {
  static const std::vector<StudyFileTable> tables{
      {"", {"inconclusive", "confidence", "maximum_failed", "minimum_experiments", "gate", "baseline"}},
      {"gate[]", {"aggregate", "minimum", "maximum", "with_confidence", "minimum_count", "reason"}},
      {"baseline", {"archive", "significance", "maximum_lost"}},
  };
  return tables;
}

GateFile parse_gates(std::string_view text, const std::string& file_name,
                     const std::vector<Finding>& findings) {
  const toml::table toml = parse_toml(text, file_name);
  const TomlTable document(toml, file_name, gate_file_keys(""));
  GateFile file;
  file.inconclusive = read_choice_or<InconclusivePolicy>(
      document, "inconclusive", {{"fail", InconclusivePolicy::fail}, {"pass", InconclusivePolicy::pass}},
      file.inconclusive);
  if (document.has("confidence"))
    file.confidence = read_number(document, "confidence", NumberRule::inside(0, 1));
  file.maximum_failed = read_whole_or(document, "maximum_failed", 0, kMaxCount, file.maximum_failed);
  file.minimum_experiments =
      read_whole_or(document, "minimum_experiments", 1, kMaxCount, file.minimum_experiments);
  if (document.has("baseline"))
    file.baseline = read_baseline(document, std::filesystem::path(file_name).parent_path());
  if (document.has("gate") || !file.baseline)
    for (const TomlTable& table : document.tables("gate", gate_file_keys("gate[]")))
      file.gates.push_back(read_gate(table, findings));
  return file;
}

GateFile load_gates(const std::filesystem::path& path, const std::vector<Finding>& findings) {
  return parse_gates(read_toml_file(path, "a gate file"), path.string(), findings);
}

}  // namespace mpm
