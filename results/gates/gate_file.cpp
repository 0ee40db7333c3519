#include "results/gates/gate_file.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t kMaxGates = kMaxCount;

/// Limits on a share must be shares. A limit of 95 would be meant as a percentage, and no result would ever
/// show that it is wrong.
NumberRule limit_rule(const Finding& finding) {
  return finding.is_share() ? NumberRule::share() : NumberRule::finite();
}

/// Refuses a gate on a method that has not assessed the loops, with a message of its own: a list of other
/// numbers would not help.
void require_assessed(const TomlTable& table, const std::vector<Finding>& findings) {
  if (!table.has("aggregate"))
    return;
  const toml::value<std::string>* name = table.require("aggregate", "").as_string();
  if (name == nullptr || find_finding(findings, name->get()) != nullptr)
    return;
  for (const AssessmentMethodInfo& method : shipped_methods().methods())
    if (name->get().starts_with(fmt::format("compare.{}.", method.name)) &&
        std::none_of(findings.begin(), findings.end(),
                     [&](const Finding& f) { return f.method == method.name; }))
      table.refuse(
          "aggregate", fmt::format("'{}', of a method that has not assessed the loops", name->get()),
          fmt::format("this number after `mpmbench compare ARCHIVE -o OUT.h5` or `mpmbench suite` with "
                      "`--methods {}`",
                      method.name));
}

const Finding& finding_of(const TomlTable& table, const std::vector<Finding>& findings) {
  std::vector<std::string> names;
  for (const Finding& finding : findings)
    names.push_back(finding.name);
  return findings[read_one_of(table, "aggregate", names)];
}

OptionKeys gate_keys(Gate& gate, const std::vector<Finding>& findings) {
  const auto read_finding = [&](const TomlTable& table, const std::string&) {
    gate.name = finding_of(table, findings).name;
  };
  const auto limit = [&](const char* name, double& value, const char* meaning) {
    OptionKey made =
        key::option(name, "number", meaning).otherwise("none").allow("finite; [0, 1] for a share");
    made.reader = [&](const TomlTable& table, const OptionKey& key) {
      value = read_number_or(table, key.name, limit_rule(finding_of(table, findings)), value);
    };
    return made;
  };
  const auto check_limits = [&](const TomlTable& table) {
    if (!table.has("minimum") && !table.has("maximum"))
      table.refuse("", "no limit", "minimum, maximum or both");
    if (gate.minimum > gate.maximum)
      table.refuse("maximum", fmt::format("{}", gate.maximum),
                   fmt::format("a number >= the minimum, {}", gate.minimum));
  };
  const auto check_interval = [&](const TomlTable& table) {
    if (gate.with_confidence && !finding_of(table, findings).has_interval)
      table.refuse("with_confidence", "true", fmt::format("false: '{}' has no interval", gate.name));
  };
  return {key::option("aggregate", "text", "the number, under the name that `mpmbench summary` prints")
              .required()
              .allow("a name of `/findings` ([file_format.md](file_format.md#findings)), those of "
                     "[methods](#gates-on-methods) too")
              .read(read_finding)
              .after([&findings](const TomlTable& table) { require_assessed(table, findings); }),
          limit("minimum", gate.minimum, "smallest allowed value"),
          limit("maximum", gate.maximum, "largest allowed value").also("at least `minimum`"),
          key::check(check_limits),
          key::flag("with_confidence", gate.with_confidence, "judge the interval instead of the value")
              .allow("`true` only for numbers with an interval"),
          key::check(check_interval),
          key::whole("minimum_count", gate.minimum_count, 1, kMaxCount,
                     "fewer experiments (pairs, for `slope` and `r_squared`) make the gate inconclusive"),
          key::text("reason", gate.reason, "reason for the limits; printed with the outcome")};
}

OptionKeys baseline_keys(BaselineLimits& limits, const std::filesystem::path& folder) {
  const auto read_archive = [&limits, folder](const TomlTable& table, const std::string& key) {
    limits.archive = folder / read_text(table, key);  // an absolute path stays as it is
  };
  const auto read_lost = [&limits](const TomlTable& table, const std::string& key) {
    limits.maximum_lost = read_whole(table, key, 0, kMaxCount);
  };
  return {key::option("archive", "text", "the earlier archive, or for a suite its earlier folder or board")
              .required()
              .allow("a path, relative to the gate file")
              .read(read_archive),
          key::number("significance", limits.significance, NumberRule::inside(0, 1),
                      "smallest p-value, corrected for the number of questions, that does not count as a "
                      "regression"),
          key::option("maximum_lost", "whole number",
                      "right verdicts of each method on each question that may be lost")
              .otherwise("no limit")
              .allow("0 to 2147483647")
              .read(read_lost)};
}

OptionKeys gate_file_keys(GateFile& file, const std::vector<Finding>& findings,
                          const std::filesystem::path& folder) {
  const auto read_baseline = [&file, folder](const TomlTable& document, const std::string& key) {
    file.baseline.emplace();
    const OptionKeys keys = baseline_keys(*file.baseline, folder);
    read_keys(document.table(key, key_names(keys)), keys);
  };
  const auto below_baseline = [] {
    BaselineLimits limits;
    return baseline_keys(limits, {});
  };
  const auto require_gates = [](const TomlTable& document) {
    if (!document.has("baseline"))
      document.require("gate", "a list of tables, one or more");
  };
  return {key::choice("inconclusive", file.inconclusive, {"fail", "pass"},
                      "whether an inconclusive gate fails the check"),
          key::option("confidence", "number", "confidence of all intervals")
              .otherwise("that of the study")
              .allow("between 0 and 1")
              .read([&file](const TomlTable& document, const std::string& key) {
                file.confidence = read_number(document, key, NumberRule::inside(0, 1));
              }),
          key::whole("maximum_failed", file.maximum_failed, 0, kMaxCount,
                     "number of experiments that may lack a result (infeasible ones do not count)"),
          key::whole("minimum_experiments", file.minimum_experiments, 1, kMaxCount,
                     "experiments that the run must have"),
          key::number("minimum_answered", file.minimum_answered, NumberRule::share(),
                      "share of its loops on which a method from outside must have answered"),
          key::list<Gate>(
              "gate", kMaxGates, [&findings](Gate& gate) { return gate_keys(gate, findings); },
              [&file](const TomlTable&, Gate& gate) { file.gates.push_back(std::move(gate)); }, "the gates")
              .otherwise("required, unless there is a `[baseline]`")
              .allow("one or more")
              .after(require_gates),
          key::option("baseline", "table", "an earlier run to compare with")
              .otherwise("none")
              .with("", below_baseline)
              .read(read_baseline)};
}

}  // namespace

std::vector<KeyTable> gate_file_tables() {
  GateFile file;
  return key_tables("", gate_file_keys(file, {}, {}));
}

GateFile parse_gates(std::string_view text, const std::string& file_name,
                     const std::vector<Finding>& findings) {
  const toml::table toml = parse_toml(text, file_name);
  GateFile file;
  const OptionKeys keys = gate_file_keys(file, findings, std::filesystem::path(file_name).parent_path());
  read_keys(TomlTable(toml, file_name, key_names(keys)), keys);
  return file;
}

GateFile load_gates(const std::filesystem::path& path, const std::vector<Finding>& findings) {
  return parse_gates(read_toml_file(path, "a gate file"), path.string(), findings);
}

}  // namespace mpm
