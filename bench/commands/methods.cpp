#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_table.hpp"
#include "analysis/methods/method_words.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "results/archive/method_json.hpp"
#include "results/document/document.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/plot_text.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

using nlohmann::ordered_json;

struct MethodsArguments {
  std::string method;
  std::vector<std::string> method_files;
  bool json = false;
};

/// The table [assessment.NAME] of the study file.
OptionKeys option_keys(const AssessmentMethodInfo& method) {
  // The texts of keys do not depend on the options that they refer to.
  MethodOptions options;
  return method.options ? method.options->keys(options) : OptionKeys{};
}

ordered_json json_of(const AssessmentMethodInfo& method) {
  ordered_json json = ordered_json::parse(method_description_json(method));
  json["options"] = ordered_json::array();
  for (const OptionKey& key : option_keys(method))
    if (!key.name.empty())
      json["options"].push_back({{"key", fmt::format("assessment.{}.{}", method.name, key.name)},
                                 {"type", key.type},
                                 {"meaning", key.meaning},
                                 {"unit", key.unit},
                                 {"default", key.fallback},
                                 {"allowed", key.allowed}});
  return json;
}

Section list_of(const MethodTable& table) {
  const std::vector<AssessmentMethodInfo>& methods = table.methods();
  Section section{"methods", "Methods of assessment"};
  Facts facts;
  for (const AssessmentMethodInfo& method : methods)
    facts.add(as_label(method.name), as_label(fmt::format("{}; needs {}; answers {}", method.title,
                                                          needs_text(method), answers_text(method))));
  section.add(std::move(facts));
  std::vector<std::string> variants;
  for (const AssessmentMethodInfo& variant : table.variants())
    variants.push_back(variant.name);
  section.say(fmt::format("By name, and not among all: {}.", listed(variants)));
  section.say("mpmbench methods NAME shows the options and numbers of one of them.");
  section.data = [&methods](ordered_json& json) {
    json["methods"] = ordered_json::array();
    for (const AssessmentMethodInfo& method : methods)
      json["methods"].push_back(json_of(method));
  };
  return section;
}

Section details_of(const AssessmentMethodInfo& method) {
  Section section{method.name, as_label(method.name)};
  Facts facts;
  facts.add("title", as_label(method.title));
  facts.add("flagged", as_label(method.verdict));
  facts.add("needs", as_label(needs_text(method)));
  facts.add("answers", as_label(answers_text(method)));
  facts.add("model", std::string(to_string(method.information)));
  section.add(std::move(facts));

  Facts options;
  for (const OptionKey& key : option_keys(method))
    if (!key.name.empty())
      options.add(as_label(key.name),
                  as_label(fmt::format("{}; default: {}", plain_meaning(key), key.fallback)));
  if (!options.list.empty()) {
    section.say(fmt::format("Options, [assessment.{}] of a study file:", as_label(method.name)));
    section.add(std::move(options));
  }

  Facts numbers;
  for (const AssessmentNumberInfo& number : method.numbers)
    numbers.add(as_label(number.name), as_label(number.meaning));
  if (!numbers.list.empty()) {
    section.say(fmt::format("Numbers, /methods/{} of an archive:", as_label(method.name)));
    section.add(std::move(numbers));
  }
  section.data = [&method](ordered_json& json) { json = json_of(method); };
  return section;
}

ExitCode describe_methods(const MethodsArguments& arguments) {
  const auto table = take_method_files(arguments.method_files).table;
  Document document;
  if (arguments.method.empty())
    document.sections.push_back(list_of(*table));
  else
    document.sections.push_back(details_of(table->method(arguments.method)));
  print_result(arguments.json ? document_json(document) : document_text(document));
  return ExitCode::done;
}

}  // namespace

void add_methods(CommandSet& commands) {
  const auto options = std::make_shared<MethodsArguments>();
  CLI::App& app =
      commands.add("methods", "List the methods, what they need and answer; or the options of one",
                   [options] { return describe_methods(*options); });
  app.add_option("NAME", options->method, "Show the options and numbers of this method");
  add_method_files(app, options->method_files);
  add_json(app, options->json);
}

}  // namespace mpm
