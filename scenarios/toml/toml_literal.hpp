#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenarios/random/distribution.hpp"

// Values as they are written in a TOML text. Each one is read back unchanged, a number to the last bit.

namespace mpm {

/// Most dots that one key of a TOML text may have. For each part of a dotted key the parser builds one table,
/// which it destroys by recursion. Up to version 3.3 it has no limit of its own: some 50 000 dots overflow
/// the stack. The limit here, together with the parser's limit on nested values (256), stays below that by a
/// factor of several.
inline constexpr std::ptrdiff_t kMaxDotsInKey = 64;

/// "0.1", "2.0", "1e-09", "-inf": never a whole number.
std::string toml_literal(double value);
std::string toml_literal(std::int64_t value);
std::string toml_literal(int value);
std::string toml_literal(bool value);
/// In double quotes, on one line.
std::string toml_literal(std::string_view text);
std::string toml_literal(const std::string& text);
std::string toml_literal(const char* text);
/// A list; many numbers take several lines.
std::string toml_literal(const Eigen::VectorXd& numbers);
std::string toml_literal(const std::vector<int>& numbers);
std::string toml_literal(const std::vector<std::string>& texts);
/// [first, second]
std::string toml_literal(const std::pair<double, double>& pair);
/// An inline table with one key, such as {uniform = [0.3, 1.5]}.
std::string toml_literal(const Distribution& distribution);

/// A key: bare, or in quotes when it has to be.
std::string toml_key(std::string_view key);

}  // namespace mpm
