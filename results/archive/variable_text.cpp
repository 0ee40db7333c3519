#include "results/archive/variable_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mpm {

bool Flags::contains(std::int64_t value) const {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::string flag_word(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

Flags yes_no_flags() {
  return {{0, 1}, {"no", "yes"}};
}

Flags index_flags(const std::vector<PlantModel::Variable>& variables) {
  Flags flags{{-1}, {"none"}};
  for (const PlantModel::Variable& variable : variables) {
    flags.values.push_back(static_cast<int>(flags.values.size()) - 1);
    flags.meanings.push_back(flag_word(variable.name));
  }
  return flags;
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
