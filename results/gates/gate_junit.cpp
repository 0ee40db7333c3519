#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "results/files/utf8.hpp"
#include "results/gates/gate_report.hpp"
#include "results/gates/gate_sentences.hpp"

namespace mpm {
namespace {

void set_attribute(pugi::xml_node element, const char* name, const std::string& value) {
  element.append_attribute(name) = plain_text(value).c_str();
}

/// Formats seconds; "0.000" if they are not known.
std::string seconds_text(double seconds) {
  return fmt::format("{:.3f}", std::isfinite(seconds) ? seconds : 0.0);
}

/// Returns "NAME", and "NAME (2)" for the second gate on the same number.
std::string case_name(const std::vector<GateResult>& results, const GateResult& result) {
  const auto before = std::count_if(
      results.data(), &result, [&](const GateResult& other) { return other.gate.name == result.gate.name; });
  return before == 0 ? result.gate.name : fmt::format("{} ({})", result.gate.name, before + 1);
}

void add_case(pugi::xml_node suite, const GateCheck& check, const GateResult& result) {
  const std::string sentence = explanation(result, check.confidence);
  pugi::xml_node test_case = suite.append_child("testcase");
  set_attribute(test_case, "classname", check.name);
  set_attribute(test_case, "name", case_name(check.results, result));
  set_attribute(test_case, "time", seconds_text(result.gate.name == "experiments" ? check.seconds : 0.0));
  if (check.stops(result)) {
    pugi::xml_node failure = test_case.append_child("failure");
    set_attribute(failure, "message", sentence);
    set_attribute(failure, "type", std::string(to_string(result.outcome)));
    failure.text() = plain_text(sentence + "\n" + details_text(check, result)).c_str();
  } else if (result.outcome == GateOutcome::inconclusive) {
    set_attribute(test_case.append_child("skipped"), "message", sentence);
  } else {
    test_case.append_child("system-out").text() = plain_text(sentence).c_str();
  }
}

void add_property(pugi::xml_node properties, const std::string& name, const std::string& value) {
  pugi::xml_node property = properties.append_child("property");
  set_attribute(property, "name", name);
  set_attribute(property, "value", value);
}

}  // namespace

std::string gates_junit(const GateCheck& check, const std::string& archive) {
  const auto failures = std::count_if(check.results.begin(), check.results.end(),
                                      [&](const GateResult& result) { return check.stops(result); });
  const auto skipped =
      std::count_if(check.results.begin(), check.results.end(), [&](const GateResult& result) {
        return result.outcome == GateOutcome::inconclusive && !check.stops(result);
      });
  pugi::xml_document document;
  pugi::xml_node suite = document.append_child("testsuites").append_child("testsuite");
  set_attribute(suite, "name", "mpmbench check " + check.name);
  set_attribute(suite, "tests", fmt::format("{}", check.results.size()));
  set_attribute(suite, "failures", fmt::format("{}", failures));
  set_attribute(suite, "errors", "0");
  set_attribute(suite, "skipped", fmt::format("{}", skipped));
  set_attribute(suite, "time", seconds_text(check.seconds));
  if (!check.created.empty())
    set_attribute(suite, "timestamp", check.created);
  pugi::xml_node properties = suite.append_child("properties");
  add_property(properties, "archive", archive);
  for (const auto& [name, value] : check.properties)
    add_property(properties, name, value);
  if (check.baseline) {
    add_property(properties, "baseline", check.baseline->path);
    for (const StudyDifference& each : check.baseline->edited)
      add_property(properties, "changed since: " + each.key, difference_text(each));
    for (const std::string& method : check.baseline->not_compared)
      add_property(properties, "not compared", method);
  }
  for (const GateResult& result : check.results)
    add_case(suite, check, result);

  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  return text.str();
}

}  // namespace mpm
