#include "plants/system/json_entry.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "plants/system/foreign_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kShownOfJsonEntry = 60;  // bytes, in a message
constexpr double kLargestNumber = std::numeric_limits<double>::max();

std::string number_range_text(double least, double most) {
  return most == kLargestNumber ? fmt::format("a number from {:g} on", least)
                                : fmt::format("a number from {:g} to {:g}", least, most);
}

}  // namespace

void JsonEntry::refuse(const std::string& allowed) const {
  throw InputError(
      place_,
      value_.is_structured()
          ? fmt::format("{} of {}", value_.is_object() ? "an object" : "a list", value_.size())
          : foreign_text(value_.dump(-1, ' ', true, Json::error_handler_t::replace), kShownOfJsonEntry),
      allowed);
}

void JsonEntry::require_keys(const std::vector<std::string>& known) const {
  require(value_.is_object(), "an object");
  for (const auto& item : value_.items())
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      throw InputError(place_,
                       fmt::format("the unknown key '{}'", foreign_text(item.key(), kShownOfJsonEntry)),
                       fmt::format("{}", fmt::join(known, ", ")));
}

JsonEntry JsonEntry::at(const std::string& key) const {
  require(value_.is_object(), fmt::format("an object with '{}'", foreign_text(key, kShownOfJsonEntry)));
  if (!value_.contains(key))
    throw InputError(place_, fmt::format("no '{}'", foreign_text(key, kShownOfJsonEntry)),
                     "an object with it");
  return {value_.at(key), fmt::format("{}: {}", place_, foreign_text(key, kShownOfJsonEntry))};
}

std::optional<JsonEntry> JsonEntry::find(const std::string& key) const {
  return has(key) && !value_.at(key).is_null() ? std::optional(at(key)) : std::nullopt;
}

std::vector<JsonEntry> JsonEntry::list(const std::string& allowed) const {
  require(value_.is_array(), allowed);
  std::vector<JsonEntry> entries;
  for (std::size_t i = 0; i < value_.size(); ++i)
    entries.emplace_back(value_[i], fmt::format("{}[{}]", place_, i));
  return entries;
}

std::string JsonEntry::text(std::size_t most) const {
  require(value_.is_string(), "a text");
  const auto& text = value_.get_ref<const std::string&>();
  if (text.size() > most)
    throw InputError(place_, fmt::format("a text of {} bytes", text.size()), fmt::format("at most {}", most));
  return text;
}

std::vector<std::string> JsonEntry::texts() const {
  std::vector<std::string> texts;
  for (const JsonEntry& entry : list("a list of texts"))
    texts.push_back(entry.text());
  return texts;
}

std::size_t JsonEntry::one_of(const std::vector<std::string>& known) const {
  const auto found =
      value_.is_string() ? std::find(known.begin(), known.end(), value_.get<std::string>()) : known.end();
  require(found != known.end(), fmt::format("{}", fmt::join(known, ", ")));
  return static_cast<std::size_t>(found - known.begin());
}

bool JsonEntry::flag() const {
  require(value_.is_boolean(), "true or false");
  return value_.get<bool>();
}

std::int64_t JsonEntry::whole(std::int64_t least, std::int64_t most) const {
  const bool fits =
      value_.is_number_integer() &&
      !(value_.is_number_unsigned() &&
        value_.get<std::uint64_t>() > static_cast<std::uint64_t>(std::max<std::int64_t>(most, 0))) &&
      value_.get<std::int64_t>() >= least && value_.get<std::int64_t>() <= most;
  require(fits, fmt::format("a whole number from {} to {}", least, most));
  return value_.get<std::int64_t>();
}

double JsonEntry::number(double least, double most) const {
  const double number = value_.is_number() ? value_.get<double>() : std::nan("");
  require(std::isfinite(number) && number >= least && number <= most,
          least == -kLargestNumber && most == kLargestNumber ? "a finite number"
                                                             : number_range_text(least, most));
  return number;
}

JsonEntry::Json parsed_json(std::string_view text, const std::string& place, const std::string& allowed) {
  JsonEntry::Json json = JsonEntry::Json::parse(text, nullptr, false);
  if (json.is_discarded())
    throw InputError(place, "no JSON", allowed);
  return json;
}

}  // namespace mpm
