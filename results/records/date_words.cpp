#include "results/records/date_words.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/date_language.hpp"
#include "results/records/written_date.hpp"

namespace mpm {
namespace {

constexpr std::size_t kLongestForeignDate = 100;  // bytes

bool may_have_words(std::string_view cell) {
  return cell.size() <= kLongestForeignDate && std::any_of(cell.begin(), cell.end(), [](unsigned char c) {
           return c >= 0x80 || std::isalpha(c) != 0;
         });
}

/// Returns the first cell of each kind. Cells that differ only in their ASCII digits are of one kind.
std::vector<std::string> kinds_of(const std::vector<std::string>& cells) {
  constexpr std::size_t kMostKinds = 100;
  std::set<std::string> shapes;
  std::vector<std::string> kinds;
  for (const std::string& cell : cells) {
    if (!may_have_words(cell) || kinds.size() == kMostKinds)
      continue;
    std::string shape;
    std::copy_if(cell.begin(), cell.end(), std::back_inserter(shape),
                 [](char c) { return c < '0' || c > '9'; });
    if (shapes.insert(shape).second)
      kinds.push_back(cell);
  }
  return kinds;
}

/// A reading of the kinds of cells, and the languages that give it.
struct DateReading {
  std::vector<std::string> english;  ///< of each kind, in English; empty: not read
  std::vector<const DateLanguage*> languages;

  std::size_t regions() const {
    std::size_t count = 0;
    for (const DateLanguage* language : languages)
      count += language_names(*language).size();
    return count;
  }
};

/// Returns the readings that read the most cells.
std::vector<DateReading> readings_of(const std::vector<std::string>& kinds,
                                     const std::function<bool(const std::string&)>& reads) {
  std::size_t most = 1;
  std::vector<DateReading> best;
  for (const DateLanguage* const language : date_languages()) {
    std::vector<std::string> english;
    for (const std::string& cell : kinds)
      english.push_back(read_in(*language, cell, reads));
    const auto read = kinds.size() - static_cast<std::size_t>(std::count(english.begin(), english.end(), ""));
    if (read < most)
      continue;
    if (read > most)
      best.clear();
    most = read;
    const auto same = std::find_if(best.begin(), best.end(),
                                   [&](const DateReading& other) { return other.english == english; });
    if (same == best.end())
      best.push_back({std::move(english), {language}});
    else
      same->languages.push_back(language);
  }
  std::sort(best.begin(), best.end(),
            [](const DateReading& a, const DateReading& b) { return a.regions() > b.regions(); });
  return best;
}

[[noreturn]] void refuse_several(const std::vector<std::string>& kinds,
                                 const std::vector<DateReading>& readings, const std::string& place) {
  constexpr std::size_t kMostShown = 5;
  const std::vector<std::string>&first = readings[0].english, &second = readings[1].english;
  const auto differs = std::mismatch(first.begin(), first.end(), second.begin()).first - first.begin();
  const auto at = static_cast<std::size_t>(differs);
  std::vector<std::string> said;
  for (const DateReading& reading : readings)
    if (said.size() < kMostShown)
      said.push_back(fmt::format("{} in {}", reading.english[at].empty() ? "none" : reading.english[at],
                                 language_names(*reading.languages.front()).front()));
  throw InputError(
      place,
      fmt::format("'{}', which is {}", cut_utf8(proper_utf8(kinds[at]), kShownBytes), fmt::join(said, ", ")),
      fmt::format("data.language = \"{}\" or another in the study file",
                  language_names(*readings.front().languages.front()).front()));
}

/// Returns the language of these cells; null if no language reads any.
const DateLanguage* language_of(const std::vector<std::string>& kinds, const std::string& place,
                                const std::function<bool(const std::string&)>& reads) {
  constexpr std::size_t kFarMore = 4;
  const std::vector<DateReading> readings = readings_of(kinds, reads);
  if (readings.empty())
    return nullptr;
  std::size_t others = 0;
  for (std::size_t i = 1; i < readings.size(); ++i)
    others += readings[i].regions();
  if (readings.front().regions() < kFarMore * others)
    refuse_several(kinds, readings, place);
  return readings.front().languages.front();
}

const DateLanguage& language_named(std::string name, const std::string& place) {
  std::replace(name.begin(), name.end(), '-', '_');
  for (const DateLanguage* const language : date_languages())
    if (std::any_of(language_names(*language).begin(), language_names(*language).end(),
                    [&](const std::string& each) { return in_lower_case(each) == in_lower_case(name); }))
      return *language;
  throw InputError(place + ": data.language", fmt::format("'{}'", cut_utf8(name, kShownBytes)),
                   "a language of CLDR, such as it, pt_BR or hr");
}

bool is_date_of_english(const std::string& cell) {
  return written_date(cell).has_value();
}

bool is_time_of_english(const std::string& cell) {
  return written_time(cell).has_value();
}

bool in_any_language(std::string_view cell, bool (*reads)(const std::string&)) {
  const std::string text(cell);
  if (reads(text))
    return true;
  if (!may_have_words(cell))
    return false;
  return has_date_words(cell) &&
         std::any_of(date_languages().begin(), date_languages().end(),
                     [&](const DateLanguage* language) { return !read_in(*language, text, reads).empty(); });
}

}  // namespace

std::optional<std::vector<std::string>> dates_in_english(
    const std::vector<std::string>& cells, const std::string& language, const std::string& place,
    const std::function<bool(const std::string&)>& reads) {
  const std::vector<std::string> kinds = kinds_of(cells);
  if (language.empty() && std::all_of(kinds.begin(), kinds.end(), reads))
    return std::nullopt;
  const DateLanguage* const found =
      language.empty() ? language_of(kinds, place, reads) : &language_named(language, place);
  if (found == nullptr)
    return std::nullopt;
  std::vector<std::string> english;
  english.reserve(cells.size());
  for (const std::string& cell : cells) {
    english.push_back(may_have_words(cell) ? read_in(*found, cell, reads) : "");
    if (english.back().empty())
      english.back() = cell;
  }
  return english;
}

bool is_date(std::string_view cell) {
  return in_any_language(cell, is_date_of_english);
}

bool is_time_of_day(std::string_view cell) {
  return !written_date(cell) && in_any_language(cell, is_time_of_english);
}

}  // namespace mpm
