#include "results/archive/method_json.hpp"

#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<NumberScope, const char*>, 5> kScopes{{{NumberScope::loop, "loop"},
                                                                      {NumberScope::cv, "cv"},
                                                                      {NumberScope::channel, "channel"},
                                                                      {NumberScope::cv_lag, "cv_lag"},
                                                                      {NumberScope::window, "window"}}};

const char* name_of(NumberScope scope) {
  for (const auto& [known, name] : kScopes)
    if (known == scope)
      return name;
  return "";
}

NumberScope scope_of(const std::string& name) {
  for (const auto& [scope, known] : kScopes)
    if (known == name)
      return scope;
  throw std::invalid_argument(fmt::format("scope '{}'", name));
}

AssessmentNumberInfo number_of(const Json& json) {
  NumberText text{.name = json.at("name"),
                  .meaning = json.at("meaning"),
                  .unit = json.at("unit"),
                  .words = numbered(json.at("words").get<std::vector<std::string>>()),
                  .heading = json.at("label")};
  const bool estimates = json.at("estimates_ivar_basis");
  const bool summarised = json.at("summarised");
  return {std::move(text), scope_of(json.at("scope")),
          estimates    ? NumberFinding::regression
          : summarised ? NumberFinding::summary
                       : NumberFinding::none};
}

/// Archives of earlier programs say nothing of it.
std::string origin_in(const Json& json) {
  const auto origin = json.find("origin");
  return origin == json.end() || origin->is_null() ? "" : origin->get<std::string>();
}

/// Nor of this.
std::optional<double> stated_in(const Json& json) {
  const auto stated = json.find("stated_false_alarms");
  if (stated == json.end() || stated->is_null())
    return std::nullopt;
  return stated->get<double>();
}

}  // namespace

Json method_json(const MethodDescription& method) {
  const AssessmentRequirements& needs = method.requirements;
  return {
      {"name", method.name},
      {"title", method.title},
      {"verdict", method.verdict},
      {"needs",
       {{"setpoints", needs.setpoints},
        {"moving_setpoints", needs.moving_setpoints},
        {"benchmark", needs.benchmark},
        {"moving_mvs", needs.moving_mvs},
        {"nominal_loop", needs.nominal_loop},
        {"complete_record", needs.complete_record}}},
      {"answers",
       {{"cv", method.locates_cvs},
        {"channel", method.names_channels},
        {"source", method.tells_sources},
        {"mismatch", method.names_mismatches},
        {"candidate", method.names_candidates}}},
      {"stated_false_alarms", method.stated_false_alarms ? Json(*method.stated_false_alarms) : Json(nullptr)},
      {"origin", method.origin.empty() ? Json(nullptr) : Json(method.origin)}};
}

std::string method_description_json(const MethodDescription& method) {
  Json json = method_json(method);
  if (!method.fingerprint.empty())
    json["fingerprint"] = method.fingerprint;
  json["numbers"] = Json::array();
  for (const AssessmentNumberInfo& number : method.numbers) {
    Json words = Json::array();
    for (const NumberWord& each : number.words)
      words.push_back(each.word);
    json["numbers"].push_back({{"name", number.name},
                               {"scope", name_of(number.scope)},
                               {"meaning", number.meaning},
                               {"unit", number.unit},
                               {"words", std::move(words)},
                               {"summarised", number.finding == NumberFinding::summary},
                               {"label", number.heading},
                               {"estimates_ivar_basis", number.finding == NumberFinding::regression}});
  }
  return json.dump();
}

MethodDescription method_description(const std::string& text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    const Json& needs = json.at("needs");
    const Json& answers = json.at("answers");
    MethodDescription method{.name = json.at("name"),
                             .title = json.at("title"),
                             .verdict = json.at("verdict"),
                             .requirements = {.setpoints = needs.at("setpoints"),
                                              .moving_setpoints = needs.at("moving_setpoints"),
                                              .benchmark = needs.at("benchmark"),
                                              .moving_mvs = needs.at("moving_mvs"),
                                              .nominal_loop = needs.value("nominal_loop", false),
                                              .complete_record = needs.value("complete_record", true)},
                             .locates_cvs = answers.at("cv"),
                             .names_channels = answers.at("channel"),
                             .tells_sources = answers.at("source"),
                             .names_mismatches = answers.value("mismatch", false),
                             .names_candidates = answers.value("candidate", false),
                             .stated_false_alarms = stated_in(json),
                             .numbers = {},
                             .origin = origin_in(json),
                             .fingerprint = json.value("fingerprint", "")};
    if (const std::size_t count = json.at("numbers").size(); count > kMostMethodNumbers)
      throw std::invalid_argument(fmt::format("{} numbers, more than {}", count, kMostMethodNumbers));
    for (const Json& number : json.at("numbers"))
      method.numbers.push_back(number_of(number));
    return method;
  } catch (const std::exception& error) {
    throw ArchiveError(fmt::format(
        "{}: attribute 'description' of a method: found {}; allowed: the description of a method as "
        "JSON",
        file, error.what()));
  }
}

}  // namespace mpm
