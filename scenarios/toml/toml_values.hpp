#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenarios/random/distribution.hpp"
#include "scenarios/toml/number_rule.hpp"

// Typed reading of the values of a TOML table. All functions refuse a value that they cannot take, as
// TomlTable does. Those ending in `_or` return their last argument for a missing key; the others refuse it.
// What they return is recorded (TomlTable::record()).

namespace mpm {

class TomlTable;

/// Two numbers in a list; what they mean is up to the reader.
using NumberPair = std::pair<double, double>;

/// A number; a whole one will do.
double read_number(const TomlTable& table, std::string_view key, const NumberRule& rule);
double read_number_or(const TomlTable& table, std::string_view key, const NumberRule& rule, double fallback);

/// A whole number from `low` to `high`.
std::int64_t read_whole(const TomlTable& table, std::string_view key, std::int64_t low, std::int64_t high);
std::int64_t read_whole_or(const TomlTable& table, std::string_view key, std::int64_t low, std::int64_t high,
                           std::int64_t fallback);

/// true or false.
bool read_flag_or(const TomlTable& table, std::string_view key, bool fallback);

/// A text that is not empty.
std::string read_text(const TomlTable& table, std::string_view key);
/// An empty fallback stands for "none" and is not recorded.
std::string read_text_or(const TomlTable& table, std::string_view key, const std::string& fallback);

/// Can the text be a bare TOML key and part of a file name: 1 to 64 letters, digits, '_' and '-'?
bool is_name(const std::string& text);

/// A text that is_name().
std::string read_name(const TomlTable& table, std::string_view key);

/// One of `names`; returns its position.
std::size_t read_one_of(const TomlTable& table, std::string_view key, const std::vector<std::string>& names);

std::size_t read_one_of_or(const TomlTable& table, std::string_view key,
                           const std::vector<std::string>& names, std::size_t fallback);

/// A list of one or more of `names`, none twice; returns their positions.
std::vector<std::size_t> read_some_of(const TomlTable& table, std::string_view key,
                                      const std::vector<std::string>& names);

/// A list of one or more texts, none empty and none twice; `allowed` says what they are.
std::vector<std::string> read_texts_or(const TomlTable& table, std::string_view key,
                                       const std::string& allowed, const std::vector<std::string>& fallback);

/// A program and its arguments: a list of one or more texts, which may repeat, and of which all but the first
/// may be empty.
std::vector<std::string> read_command(const TomlTable& table, std::string_view key);

/// Seconds that a program may take for an answer: above 0, and a day at most.
double read_time_limit_or(const TomlTable& table, std::string_view key, double fallback);

/// A list of 1 to `longest` numbers, each within `rule`.
Eigen::VectorXd read_numbers(const TomlTable& table, std::string_view key, const NumberRule& rule,
                             std::size_t longest);

/// Two finite numbers; `allowed` says what they mean.
NumberPair read_pair(const TomlTable& table, std::string_view key, const std::string& allowed);

/// [low, high] with low < high and both within `rule`.
NumberPair read_band_or(const TomlTable& table, std::string_view key, const NumberRule& rule,
                        const NumberPair& fallback);

/// Limits [low, high] with low <= high. -inf as the lower and inf as the upper one stand for no limit.
NumberPair read_limits(const TomlTable& table, std::string_view key);

/// A distribution written as an inline table with one key, such as {uniform = [0.3, 1.5]}, whose every draw
/// satisfies `rule`.
Distribution read_distribution(const TomlTable& table, std::string_view key, const NumberRule& rule);
Distribution read_distribution_or(const TomlTable& table, std::string_view key, const NumberRule& rule,
                                  const Distribution& fallback);

}  // namespace mpm
