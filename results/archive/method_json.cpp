#include "results/archive/method_json.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "base/error.hpp"
#include "base/system/json_entry.hpp"
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

NumberScope scope_of(const JsonEntry& entry) {
  for (const auto& [scope, known] : kScopes)
    if (known == entry.text())
      return scope;
  entry.refuse("loop, cv, channel, cv_lag or window");
}

/// Reads a text of any length: this program limited the length when it wrote the text.
std::string whole_text(const JsonEntry& entry) {
  return entry.text(std::numeric_limits<std::size_t>::max());
}

AssessmentNumberInfo number_of(const JsonEntry& entry) {
  const bool estimates = entry.at("estimates_ivar_basis").flag();
  const bool summarised = entry.at("summarised").flag();
  return {{.name = whole_text(entry.at("name")),
           .meaning = whole_text(entry.at("meaning")),
           .unit = whole_text(entry.at("unit")),
           .words = numbered(entry.at("words").texts()),
           .heading = whole_text(entry.at("label"))},
          scope_of(entry.at("scope")),
          estimates    ? NumberFinding::regression
          : summarised ? NumberFinding::summary
                       : NumberFinding::none};
}

/// Returns a text, or an empty one if `entry` is from an archive of an earlier program that did not store it.
std::string text_or_nothing(const JsonEntry& entry, const char* key) {
  const std::optional<JsonEntry> found = entry.find(key);
  return found ? whole_text(*found) : "";
}

bool flag_or(const JsonEntry& entry, const char* key, bool fallback) {
  return entry.has(key) ? entry.at(key).flag() : fallback;
}

MethodDescription description_in(const JsonEntry& entry) {
  const JsonEntry needs = entry.at("needs"), answers = entry.at("answers");
  const std::optional<JsonEntry> stated = entry.find("stated_false_alarms");
  MethodDescription method{.name = whole_text(entry.at("name")),
                           .title = whole_text(entry.at("title")),
                           .verdict = whole_text(entry.at("verdict")),
                           .requirements = {.setpoints = needs.at("setpoints").flag(),
                                            .moving_setpoints = needs.at("moving_setpoints").flag(),
                                            .benchmark = needs.at("benchmark").flag(),
                                            .moving_mvs = needs.at("moving_mvs").flag(),
                                            .nominal_loop = flag_or(needs, "nominal_loop", false),
                                            .complete_record = flag_or(needs, "complete_record", true)},
                           .locates_cvs = answers.at("cv").flag(),
                           .names_channels = answers.at("channel").flag(),
                           .tells_sources = answers.at("source").flag(),
                           .names_mismatches = flag_or(answers, "mismatch", false),
                           .names_candidates = flag_or(answers, "candidate", false),
                           .stated_false_alarms = stated ? std::optional(stated->number()) : std::nullopt,
                           .numbers = {},
                           .origin = text_or_nothing(entry, "origin"),
                           .fingerprint = text_or_nothing(entry, "fingerprint"),
                           .given_options = text_or_nothing(entry, "given_options")};
  const std::vector<JsonEntry> numbers = entry.at("numbers").list();
  entry.at("numbers").require(numbers.size() <= kMostMethodNumbers,
                              fmt::format("at most {}", kMostMethodNumbers));
  for (const JsonEntry& number : numbers)
    method.numbers.push_back(number_of(number));
  return method;
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
  if (!method.given_options.empty())
    json["given_options"] = method.given_options;
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
  const std::string place = fmt::format("{}: attribute 'description' of a method", file);
  try {
    const Json json = parsed_json(text, place, "the description of a method as JSON");
    return description_in({json, place});
  } catch (const InputError& error) {
    throw ArchiveError(error.what());
  }
}

}  // namespace mpm
