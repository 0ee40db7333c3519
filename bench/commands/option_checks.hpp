#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace mpm {

/// A whole number from `lowest` to `highest` in decimal digits: no octal 010, nothing that wraps around.
CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest);

/// A number from `lowest` to `highest`; refuses NaN.
CLI::Validator number_between(double lowest, double highest);

/// A number > 0, not infinite.
CLI::Validator positive_number();

/// One of these words.
CLI::Validator one_of(std::vector<std::string> words);

/// Adds an option that takes one of several words, each of which stands for a value. The present value is the
/// default.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::vector<std::pair<std::string, Value>>& choices,
                        const std::string& description) {
  std::vector<std::string> words;
  std::string now;
  for (const auto& [word, meaning] : choices) {
    words.push_back(word);
    if (meaning == value)
      now = word;
  }
  const auto take = [choices, &value](const std::string& chosen) {
    for (const auto& [word, meaning] : choices)
      if (word == chosen)
        value = meaning;
  };
  return app.add_option_function<std::string>(name, take, description)
      ->check(one_of(words))
      ->default_str(now);
}

}  // namespace mpm
