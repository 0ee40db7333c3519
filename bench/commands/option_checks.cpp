#include "bench/commands/option_checks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/parts/whole_number.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

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
    const auto number = whole_number_in<std::uint64_t>(word);
    const bool fits = number && *number >= lowest && *number <= highest;
    return fits ? std::string()
                : fmt::format("found {}; allowed: a whole number from {} to {}", word, lowest, highest);
  };
  constexpr std::uint64_t kWorthShowing = 1'000'000;
  return {check, highest > kWorthShowing ? "" : fmt::format("{} to {}", lowest, highest)};
}

CLI::Validator number_between(double lowest, double highest) {
  const auto check = [lowest, highest](const std::string& word) {
    const std::optional<double> number = number_in(word);
    const bool fits = number && *number >= lowest && *number <= highest;  // NaN does not
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

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string all = fmt::format("{}", fmt::join(words, ","));
  const auto check = [words = std::move(words)](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end()
               ? std::string()
               : fmt::format("found {}; allowed: {}", with_nearest(word, words), fmt::join(words, ", "));
  };
  return {check, "{" + all + "}"};
}

}  // namespace mpm
