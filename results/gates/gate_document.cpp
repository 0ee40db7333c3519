#include "results/gates/gate_document.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "results/gates/gate_sentences.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json gate_json(const GateCheck& check, const GateResult& result) {
  const Gate& gate = result.gate;
  const Finding& measured = result.measured;
  return {{"name", gate.name},
          {"minimum", gate.minimum},
          {"maximum", gate.maximum},
          {"with_confidence", gate.with_confidence},
          {"minimum_count", gate.minimum_count},
          {"reason", gate.reason},
          {"value", measured.value},
          {"lower", measured.interval.lower},
          {"upper", measured.interval.upper},
          {"count", measured.count},
          {"margin", result.margin},
          {"outcome", to_string(result.outcome)},
          {"stops", check.stops(result)},
          {"explanation", explanation(result, check.confidence)}};
}

Json pairs_json(const std::vector<JudgementPair>& pairs) {
  Json json = Json::array();
  for (const JudgementPair& pair : pairs)
    json.push_back({{"index", pair.index},
                    {"cell", pair.cell},
                    {"before", to_string(pair.before)},
                    {"now", to_string(pair.now)}});
  return json;
}

Json baseline_json(const BaselineComparison& baseline) {
  Json json{{"archive", baseline.path},
            {"run_by", baseline.run_by},
            {"changed_since", Json::array()},
            {"not_compared", baseline.not_compared},
            {"questions", Json::array()}};
  for (const StudyDifference& each : baseline.edited)
    json["changed_since"].push_back({{"key", each.key}, {"before", each.before}, {"now", each.now}});
  for (const BaselineChanges& each : baseline.questions)
    json["questions"].push_back({{"name", each.name},
                                 {"pairs", each.changes.pairs},
                                 {"lost", pairs_json(each.changes.lost)},
                                 {"gained", pairs_json(each.changes.gained)},
                                 {"p_worse", each.changes.test().p_worse},
                                 {"p_worse_corrected", each.p_worse}});
  return json;
}

Json check_json(const GateCheck& check, const std::string& archive) {
  Json json{{"name", check.name},
            {"archive", archive},
            {"passed", check.passed()},
            {"inconclusive", check.inconclusive == InconclusivePolicy::fail ? "fail" : "pass"},
            {"confidence", check.confidence},
            {"run", Json::object()},
            {"gates", Json::array()},
            {"baseline", check.baseline ? baseline_json(*check.baseline) : Json()}};
  for (const auto& [name, value] : check.properties)
    json["run"][name] = value;
  for (const GateResult& result : check.results)
    json["gates"].push_back(gate_json(check, result));
  return json;
}

/// Lists experiments: "17, 23"; for a suite, the cell comes before each loop.
std::string experiments_text(const std::vector<JudgementPair>& pairs) {
  std::vector<std::string> names;
  for (const JudgementPair& pair : pairs)
    names.push_back(fmt::format("{}{}{}", pair.cell, pair.cell.empty() ? "" : " ", pair.index));
  return names.empty() ? "-" : fmt::to_string(fmt::join(names, ", "));
}

void add_baseline(Section& section, const BaselineComparison& baseline) {
  section.say(as_label(fmt::format("Against the baseline {} ({}):", baseline.path, baseline.run_by)));
  Sentences differences;
  for (const StudyDifference& each : baseline.edited)
    differences.words.push_back(
        as_label(fmt::format("changed since: {}: {}", each.key, difference_text(each))));
  if (!baseline.not_compared.empty())
    differences.words.push_back(as_label(fmt::format("not compared, since only one of the two has it: {}",
                                                     fmt::join(baseline.not_compared, ", "))));
  if (!differences.words.empty())
    section.add(differences);
  Table table("",
              {{"question", Table::Align::left}, {"experiments"}, {"lost"}, {"gained"}, {"p, corrected"}});
  for (const BaselineChanges& each : baseline.questions)
    if (each.changed())
      table.row({as_label(each.title), each.changes.pairs, as_label(experiments_text(each.changes.lost)),
                 as_label(experiments_text(each.changes.gained)), fmt::format("{:.3g}", each.p_worse)});
  if (table.rows.empty())
    section.say("No verdict changed.");
  else
    section.add(table);
}

}  // namespace

Table gate_table(const GateCheck& check) {
  Table table("", {{"gate", Table::Align::left},
                   {"limit"},
                   {"judged by"},
                   {"measured"},
                   {fmt::format("{:g} % interval", 100.0 * check.confidence)},
                   {"count"},
                   {"margin"},
                   {"outcome", Table::Align::left}});
  for (const GateResult& result : check.results)
    table.row({as_label(result.gate.name), limit_text(result),
               result.gate.with_confidence ? "interval" : "value", measured_text(result),
               interval_text(result), result.measured.count, margin_text(result),
               std::string(to_string(result.outcome))});
  return table;
}

Document gates_document(const GateCheck& check, const std::string& archive) {
  Section section;
  section.say(as_label(fmt::format("{}: {}", check.name, verdict_sentence(check))),
              check.passed() ? Paragraph::Kind::passed : Paragraph::Kind::failed);
  section.add(gate_table(check));
  Sentences reasons;
  for (const GateResult& result : check.results)
    if (result.outcome != GateOutcome::pass)
      reasons.words.push_back(as_label(explanation(result, check.confidence)));
  if (!reasons.words.empty())
    section.add(reasons);
  if (check.baseline)
    add_baseline(section, *check.baseline);
  section.data = [&check, archive](Json& json) { json = check_json(check, archive); };
  Document document;
  document.sections.push_back(std::move(section));
  return document;
}

}  // namespace mpm
