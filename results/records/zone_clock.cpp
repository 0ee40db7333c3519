#include "results/records/zone_clock.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <date/tz.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

constexpr double kHourOfZone = 3600.0;  // s

const date::time_zone* zone_named(const std::string& name, const std::string& place) {
  try {
    return date::locate_zone(name);
  } catch (const std::exception&) {  // also if there is no database
    throw InputError(place, fmt::format("'{}'", cut_utf8(name, kShownBytes)),
                     "a name of the time zone database, such as Europe/Berlin, America/Chicago or UTC");
  }
}

}  // namespace

struct ZoneClock::Zone {
  const date::time_zone* zone;
};

ZoneClock::ZoneClock(const std::string& name, const std::string& place)
    : zone_(std::make_unique<const Zone>(Zone{zone_named(name, place)})) {}
ZoneClock::~ZoneClock() = default;
ZoneClock::ZoneClock(ZoneClock&&) noexcept = default;
ZoneClock& ZoneClock::operator=(ZoneClock&&) noexcept = default;

std::optional<double> ZoneClock::utc(double local, const std::string& letters, double earliest) const {
  const double whole = std::floor(local);
  const date::local_seconds at{std::chrono::seconds(static_cast<std::int64_t>(whole))};
  const date::local_info info = zone_->zone->get_info(at);
  if (info.result == date::local_info::nonexistent)
    return std::nullopt;
  const bool twice = info.result == date::local_info::ambiguous;
  const auto time = [&](const date::sys_info& of) { return local - static_cast<double>(of.offset.count()); };
  if (letters.empty())
    return twice && time(info.first) < earliest ? time(info.second) : time(info.first);
  if (info.first.abbrev == letters)
    return time(info.first);
  return twice && info.second.abbrev == letters ? std::optional(time(info.second)) : std::nullopt;
}

std::optional<double> offset_of_letters(const std::string& letters) {
  static constexpr std::array<std::pair<std::string_view, double>, 22> kZones{
      {{"UTC", 0},   {"GMT", 0},   {"WET", 0},  {"WEST", 1}, {"CET", 1},  {"CEST", 2},
       {"MEZ", 1},   {"MESZ", 2},  {"EET", 2},  {"EEST", 3}, {"MSK", 3},  {"EST", -5},
       {"EDT", -4},  {"CDT", -5},  {"MST", -7}, {"MDT", -6}, {"PST", -8}, {"PDT", -7},
       {"AKST", -9}, {"AKDT", -8}, {"JST", 9},  {"KST", 9}}};
  const auto* const found =
      std::find_if(kZones.begin(), kZones.end(), [&](const auto& zone) { return zone.first == letters; });
  return found == kZones.end() ? std::nullopt : std::optional(kHourOfZone * found->second);
}

}  // namespace mpm
