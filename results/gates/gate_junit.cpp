#include <algorithm>
#include <sstream>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <fmt/format.h>

#include "results/files/utf8.hpp"
#include "results/gates/gate_report.hpp"
#include "results/gates/gate_words.hpp"

namespace mpm {
namespace {

using Tree = boost::property_tree::ptree;

/// A path of one step: names here have dots, which the library would read as steps of a path.
Tree& child(Tree& tree, const std::string& name) {
  return tree.push_back({name, Tree()})->second;
}

void set_attribute(Tree& element, const std::string& name, const std::string& value) {
  const auto attributes = element.find("<xmlattr>");
  Tree& list = attributes == element.not_found() ? child(element, "<xmlattr>")
                                                 : element.to_iterator(attributes)->second;
  child(list, name).data() = plain_text(value);
}

void add_case(Tree& suite, const GateCheck& check, const GateResult& result, const std::string& study) {
  const std::string sentence = explanation(result, check.confidence);
  Tree& test_case = child(suite, "testcase");
  set_attribute(test_case, "classname", study);
  set_attribute(test_case, "name",
                fmt::format("{} {}{}", result.gate.name, limit_text(result.gate),
                            result.gate.with_confidence ? " with confidence" : ""));
  if (check.stops(result)) {
    Tree& failure = child(test_case, "failure");
    set_attribute(failure, "message", sentence);
    set_attribute(failure, "type", std::string(to_string(result.outcome)));
    failure.data() = plain_text(sentence + "\n" + details_text(check, result));
  } else if (result.outcome == GateOutcome::inconclusive) {
    set_attribute(child(test_case, "skipped"), "message", sentence);
  } else {
    child(test_case, "system-out").data() = plain_text(sentence);
  }
}

void add_property(Tree& properties, const std::string& name, const std::string& value) {
  Tree& property = child(properties, "property");
  set_attribute(property, "name", name);
  set_attribute(property, "value", value);
}

}  // namespace

std::string gates_junit(const GateCheck& check, const Campaign& campaign, const std::string& archive) {
  const auto failures = std::count_if(check.results.begin(), check.results.end(),
                                      [&](const GateResult& result) { return check.stops(result); });
  const auto skipped =
      std::count_if(check.results.begin(), check.results.end(), [&](const GateResult& result) {
        return result.outcome == GateOutcome::inconclusive && !check.stops(result);
      });
  Tree document;
  Tree& suite = child(child(document, "testsuites"), "testsuite");
  set_attribute(suite, "name", "mpmbench check " + campaign.study.name);
  set_attribute(suite, "tests", fmt::format("{}", check.results.size()));
  set_attribute(suite, "failures", fmt::format("{}", failures));
  set_attribute(suite, "errors", "0");
  set_attribute(suite, "skipped", fmt::format("{}", skipped));
  Tree& properties = child(suite, "properties");
  add_property(properties, "archive", archive);
  add_property(properties, "seed", fmt::format("{}", campaign.study.seed));
  add_property(properties, "solver", campaign.info.solver);
  add_property(properties, "mpmbench_version", campaign.info.mpmbench_version);
  add_property(properties, "git_sha", campaign.info.git_sha);
  for (const GateResult& result : check.results)
    add_case(suite, check, result, campaign.study.name);

  std::ostringstream text;
  boost::property_tree::write_xml(text, document,
                                  boost::property_tree::xml_writer_make_settings<std::string>(' ', 2));
  return text.str();
}

}  // namespace mpm
