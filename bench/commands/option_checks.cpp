#include "bench/commands/option_checks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace mpm {
namespace {

bool is_decimal(const std::string& word) {
  const bool digits =
      !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits && (word.size() == 1 || word.front() != '0');
}

/// The whole word as a decimal number.
std::optional<double> number_in(const std::string& word) {
  double number = 0.0;
  const char* const end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, number);
  return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

}  // namespace

CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest) {
  const auto check = [lowest, highest](const std::string& word) {
    std::uint64_t number = 0;
    const char* const end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, number);
    const bool fits = is_decimal(word) && read.ec == std::errc() && number >= lowest && number <= highest;
    return fits ? std::string()
                : fmt::format("found {}; allowed: a whole number from {} to {}", word, lowest, highest);
  };
  constexpr std::uint64_t kWorthShowing = 1'000'000;
  return {check, highest > kWorthShowing ? "" : fmt::format("{} to {}", lowest, highest)};
}

CLI::Validator number_between(double lowest, double highest) {
  const auto check = [lowest, highest](const std::string& word) {
    const std::optional<double> number = number_in(word);
    const bool fits = number && *number >= lowest && *number <= highest;  // NaN is not
    return fits ? std::string()
                : fmt::format("found {}; allowed: a number from {} to {}", word, lowest, highest);
  };
  return {check, fmt::format("{} to {}", lowest, highest)};
}

CLI::Validator positive_number() {
  const auto check = [](const std::string& word) {
    const std::optional<double> number = number_in(word);
    const bool fits = number && *number > 0.0 && std::isfinite(*number);
    return fits ? std::string() : fmt::format("found {}; allowed: a number > 0", word);
  };
  return {check, "> 0"};
}

}  // namespace mpm
