#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "results/archive/hdf5_file.hpp"

namespace mpm {

/// The values that a flag variable can have, and a word for each.
struct Flags {
  std::vector<int> values;
  std::vector<std::string> meanings;

  bool contains(std::int64_t value) const;
};

/// What a file says of a variable to people and programs.
struct VariableText {
  std::string name;
  std::string long_name;
  std::string units = "1";
  std::string comment = {};      ///< how to read special values; none when empty
  Flags flags = {};              ///< for flag variables
  std::string coordinates = {};  ///< a variable with further coordinates, such as `time`; none when empty
};

/// `long_name`, `units` and, where there are any, `comment`, `coordinates`, `flag_values` (of the type T of
/// the variable, as the CF conventions want it) and `flag_meanings`.
template <class T>
Attributes attributes(const VariableText& text) {
  Attributes list{{"long_name", text.long_name}, {"units", text.units}};
  if (!text.comment.empty())
    list.emplace_back("comment", text.comment);
  if (!text.coordinates.empty())
    list.emplace_back("coordinates", text.coordinates);
  if constexpr (std::is_same_v<T, std::int8_t> || std::is_same_v<T, std::int32_t>) {
    if (!text.flags.values.empty()) {
      list.emplace_back("flag_values", std::vector<T>(text.flags.values.begin(), text.flags.values.end()));
      std::string meanings;
      for (const std::string& meaning : text.flags.meanings)
        meanings += (meanings.empty() ? "" : " ") + meaning;
      list.emplace_back("flag_meanings", meanings);
    }
  }
  return list;
}

/// The first of the values of a flag variable that has no meaning; null when there is none.
template <class T>
const T* value_without_meaning(const VariableText& text, const std::vector<T>& values) {
  if constexpr (std::is_integral_v<T>)
    for (const T& value : values)
      if (!text.flags.values.empty() && !text.flags.contains(value))
        return &value;
  return nullptr;
}

/// A word of `Flags::meanings`: with '_' for blanks, which separate them in a file.
std::string flag_word(std::string text);
/// 0: no, 1: yes.
Flags yes_no_flags();
/// -1: none, then the position of each variable under its name, with '_' for blanks.
Flags index_flags(const std::vector<PlantModel::Variable>& variables);

/// `unit` as an attribute: "1" for an empty one. Units of time get their symbols ("min" for "minutes"),
/// because xarray turns a variable in "minutes" into time spans and loses its digits.
std::string unit_text(const std::string& unit);
/// The unit that all these variables have; "various" when they have different ones. A dimension lists the
/// unit of each variable in its attribute `variable_units`.
std::string common_unit(const std::vector<PlantModel::Variable>& variables);

}  // namespace mpm
