#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace mpm {

/// The whole number in a text that has nothing else; none for any other text. 010, which some read as eight,
/// is not accepted.
template <class Number = std::int64_t>
std::optional<Number> whole_number_in(std::string_view text) {
  if (text.size() > 1 && text.front() == '0')
    return std::nullopt;
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace mpm
