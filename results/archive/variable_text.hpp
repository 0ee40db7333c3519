#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "base/number_text.hpp"
#include "plants/linear/plant_model.hpp"
#include "results/archive/hdf5_file.hpp"

namespace mpm {

// What a file says about a number to people and programs.

/// A word in the form of files: with '_' for blanks, which separate the words of an attribute.
std::string flag_word(std::string text);

/// `long_name`, `units` and, where there are any, `comment`, `coordinates` (a variable with further ones,
/// such as `time`), `flag_values` (of the type T of the variable, as the CF conventions want it) and
/// `flag_meanings`.
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

/// The first of these values that is to have a word and has none; null when there is none.
template <class T>
const T* value_without_word(const NumberText& text, const std::vector<T>& values) {
  if constexpr (std::is_integral_v<T>)
    for (const T& value : values)
      if (!text.words.empty() && word_for(text.words, value) == nullptr)
        return &value;
  return nullptr;
}

/// The words behind -1 for "none".
std::vector<NumberWord> with_none(std::vector<NumberWord> words, const char* none = "none");
/// -1: none, then the position of each variable under its name.
std::vector<NumberWord> index_words(const std::vector<PlantModel::Variable>& variables);

/// `unit` as an attribute: "1" for an empty one. Units of time get their symbols ("min" for "minutes"),
/// because xarray turns a variable in "minutes" into time spans and loses its digits.
std::string unit_text(const std::string& unit);
/// The unit that all these variables have; "various" when they have different ones. A dimension lists the
/// unit of each variable in its attribute `variable_units`.
std::string common_unit(const std::vector<PlantModel::Variable>& variables);

}  // namespace mpm
