#include "results/archive/campaign_differences.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace mpm {
namespace {

using OptionJson = nlohmann::ordered_json;
using Keys = std::map<std::string, std::string>;

void add_keys(const OptionJson& value, const std::string& key, Keys& keys) {
  if (!value.is_object()) {
    keys[key] = value.dump(-1, ' ', false, OptionJson::error_handler_t::replace);
    return;
  }
  for (const auto& item : value.items())
    add_keys(item.value(), fmt::format("{}.{}", key, item.key()), keys);
}

/// Returns the keys that decide the answers of a method from outside.
Keys keys_of(const MethodDescription& method) {
  Keys keys;
  const std::string of = fmt::format("method.{}", method.name);
  std::string command = method.fingerprint.empty() ? method.origin : method.fingerprint;
  const std::string behind = fmt::format(", options {}", method.given_options);
  if (!method.given_options.empty() && command.ends_with(behind))
    command.resize(command.size() - behind.size());
  keys[of + ".command"] = std::move(command);
  const OptionJson options = OptionJson::parse(method.given_options, nullptr, false);
  if (!options.is_discarded())
    add_keys(options, of + ".options", keys);
  return keys;
}

/// Adds the keys whose values differ. A key that only one side has gets an empty value on the other.
void add_differences(const Keys& before, const Keys& now, std::vector<StudyDifference>& differences) {
  std::set<std::string> names;
  for (const Keys* const keys : {&before, &now})
    for (const auto& each : *keys)
      names.insert(each.first);
  const auto value = [](const Keys& keys, const std::string& name) {
    const auto found = keys.find(name);
    return found == keys.end() ? std::string() : found->second;
  };
  for (const std::string& name : names)
    if (const std::string was = value(before, name), is = value(now, name); was != is)
      differences.push_back({name, was, is});
}

const MethodDescription* method_in(const Campaign& campaign, const std::string& name) {
  const auto found =
      std::find_if(campaign.methods.begin(), campaign.methods.end(),
                   [&name](const CampaignMethod& method) { return method.form->method().name == name; });
  return found == campaign.methods.end() ? nullptr : &found->form->method();
}

}  // namespace

std::vector<StudyDifference> campaign_differences(const Campaign& before, const Campaign& now) {
  std::vector<StudyDifference> differences;
  if (before.study.source != now.study.source || before.study.seed != now.study.seed)
    differences = study_differences(before.study, now.study);
  for (const CampaignMethod& method : now.methods) {
    const MethodDescription& is = method.form->method();
    if (const MethodDescription* const was = method_in(before, is.name))
      add_differences(keys_of(*was), keys_of(is), differences);
  }
  return differences;
}

std::vector<std::string> methods_alone(const Campaign& campaign, const Campaign& other) {
  std::vector<std::string> names = method_names(campaign);
  std::erase_if(names, [&other](const std::string& name) { return method_in(other, name) != nullptr; });
  return names;
}

}  // namespace mpm
