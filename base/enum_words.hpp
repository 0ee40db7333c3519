#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace mpm {

/// The words by which messages, archives, bytes, JSON and TOML name the values of an enumeration. The values
/// count from 0, and each has one word. Beside the enumeration, define for example
///
///   template <>
///   inline constexpr auto kWords<FindingForm> = word_list("share", "number");
template <class Enum>
inline constexpr std::nullptr_t kWords = nullptr;

template <class... Words>
constexpr std::array<std::string_view, sizeof...(Words)> word_list(const Words&... list) {
  return {std::string_view(list)...};
}

template <class Enum>
concept WordedEnum = std::is_enum_v<Enum> && !std::is_same_v<decltype(kWords<Enum>), const std::nullptr_t>;

/// The word for a value; "unknown" for a number that is no value.
template <WordedEnum Enum>
constexpr std::string_view to_string(Enum value) {
  const auto place = static_cast<std::size_t>(value);
  return place < kWords<Enum>.size() ? kWords<Enum>[place] : "unknown";
}

/// Returns the value that a word stands for, or none if no value has this word.
template <WordedEnum Enum>
constexpr std::optional<Enum> enumerator(std::string_view word) {
  for (std::size_t place = 0; place < kWords<Enum>.size(); ++place)
    if (kWords<Enum>[place] == word)
      return static_cast<Enum>(place);
  return std::nullopt;
}

/// All values, in their order.
template <WordedEnum Enum>
constexpr auto enumerators() {
  std::array<Enum, kWords<Enum>.size()> list{};
  for (std::size_t place = 0; place < list.size(); ++place)
    list[place] = static_cast<Enum>(place);
  return list;
}

}  // namespace mpm
