#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/enum_words.hpp"

namespace mpm {

/// A value that a number can have, and the word for it.
struct NumberWord {
  int value;
  std::string word;
};

/// The description of a number wherever it is shown: in archives, tables, figures and documents.
struct NumberText {
  std::string name;                    ///< in the form of a variable name, unique among the numbers beside it
  std::string meaning;                 ///< what it is, in one line, with its equation
  std::string unit = "1";              ///< "1", "degrees", "samples", ...
  std::string special = {};            ///< how to read special values; empty: there are none
  std::vector<NumberWord> words = {};  ///< all values of a verdict or a position; empty for a quantity
  std::string heading = {};            ///< in tables and figures, such as "I_{MPM}"; empty: none
};

/// Words for 0, 1, 2, ...
template <class Words>
std::vector<NumberWord> numbered(const Words& words) {
  std::vector<NumberWord> list;
  for (const auto& word : words)
    list.push_back({static_cast<int>(list.size()), std::string(word)});
  return list;
}
inline std::vector<NumberWord> numbered(std::initializer_list<const char*> words) {
  return numbered<std::initializer_list<const char*>>(words);
}

/// 0: no, 1: yes.
inline std::vector<NumberWord> no_yes() {
  return numbered({"no", "yes"});
}

/// The words of all values of an enumeration.
template <WordedEnum Enum>
std::vector<NumberWord> enum_words() {
  return numbered(kWords<Enum>);
}
/// The words of some values, from the to_string() of each.
template <class Enumerators>
std::vector<NumberWord> enum_words(const Enumerators& enumerators) {
  std::vector<NumberWord> words;
  for (const auto enumerator : enumerators)
    words.push_back({static_cast<int>(enumerator), std::string(to_string(enumerator))});
  return words;
}

/// The word for a value; null when it has none.
template <class Value>
const std::string* word_for(const std::vector<NumberWord>& words, Value value) {
  for (const NumberWord& each : words)
    if (static_cast<Value>(each.value) == value)
      return &each.word;
  return nullptr;
}

}  // namespace mpm
