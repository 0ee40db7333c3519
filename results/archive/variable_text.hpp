#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "base/number_text.hpp"
#include "plants/linear/plant_model.hpp"
#include "results/archive/hdf5_file.hpp"

namespace mpm {

// What a file tells people and programs about a number.

/// Returns a word as files store it: with '_' for blanks, because blanks separate the words of an attribute.
std::string flag_word(std::string text);

/// Returns the attributes of a variable: `long_name`, `units` and, if the variable has them, `comment`,
/// `coordinates` (further coordinates, such as `time`), `flag_values` (of the variable's type T, as the CF
/// conventions require) and `flag_meanings`.
template <class T>
Attributes attributes(const NumberText& text, const std::string& coordinates = {}) {
  Attributes list{{"long_name", text.meaning}, {"units", text.unit}};
  if (!text.special.empty())
    list.emplace_back("comment", text.special);
  if (!coordinates.empty())
    list.emplace_back("coordinates", coordinates);
  if constexpr (std::is_same_v<T, std::int8_t> || std::is_same_v<T, std::int32_t>) {
    if (!text.words.empty()) {
      std::vector<T> values;
      std::string meanings;
      for (const auto& [value, word] : text.words) {
        values.push_back(static_cast<T>(value));
        meanings += (meanings.empty() ? "" : " ") + flag_word(word);
      }
      list.emplace_back("flag_values", values);
      list.emplace_back("flag_meanings", meanings);
    }
  }
  return list;
}

/// Returns the first of these values that must have a word and has none; null if there is none.
template <class T>
const T* value_without_word(const NumberText& text, const std::vector<T>& values) {
  if constexpr (std::is_integral_v<T>)
    for (const T& value : values)
      if (!text.words.empty() && word_for(text.words, value) == nullptr)
        return &value;
  return nullptr;
}

/// Returns `words` after the word `none` for -1.
std::vector<NumberWord> with_none(std::vector<NumberWord> words, const char* none = "none");
/// Returns "none" for -1, then the name of each variable for its position.
std::vector<NumberWord> index_words(const std::vector<PlantModel::Variable>& variables);

/// Returns `unit` as an attribute: "1" if it is empty. Units of time become their symbols ("min" for
/// "minutes"), because xarray would turn a variable in "minutes" into time spans and lose its digits.
std::string unit_text(const std::string& unit);
/// Returns the unit that all these variables have, or "various" if they differ. A dimension lists the unit of
/// each variable in its attribute `variable_units`.
std::string common_unit(const std::vector<PlantModel::Variable>& variables);

}  // namespace mpm
