#include "results/archive/variable_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mpm {

std::string flag_word(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

std::vector<NumberWord> with_none(std::vector<NumberWord> words, const char* none) {
  words.insert(words.begin(), {-1, none});
  return words;
}

std::vector<NumberWord> index_words(const std::vector<PlantModel::Variable>& variables) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& variable : variables)
    names.push_back(variable.name);
  return with_none(numbered(names));
}

std::string unit_text(const std::string& unit) {
  static const std::array<std::pair<const char*, const char*>, 7> kSymbols{{{"days", "d"},
                                                                            {"hours", "h"},
                                                                            {"minutes", "min"},
                                                                            {"seconds", "s"},
                                                                            {"milliseconds", "ms"},
                                                                            {"microseconds", "us"},
                                                                            {"nanoseconds", "ns"}}};
  for (const auto& [word, symbol] : kSymbols)
    if (unit == word)
      return symbol;
  return unit.empty() ? "1" : unit;
}

std::string common_unit(const std::vector<PlantModel::Variable>& variables) {
  if (variables.empty())
    return "1";
  const std::string first = unit_text(variables.front().unit);
  const bool same = std::all_of(variables.begin(), variables.end(),
                                [&](const auto& variable) { return unit_text(variable.unit) == first; });
  return same ? first : "various";
}

}  // namespace mpm
