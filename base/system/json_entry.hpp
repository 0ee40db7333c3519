#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace mpm {

/// A JSON value that somebody else has written, with its place for messages, such as "FILE: cells[3]: study".
/// The JSON value must outlive all entries that are read from it.
///
/// Each member function that asks for something throws InputError "PLACE: found ...; allowed: ..." if it
/// finds anything else, so that no message of the JSON library reaches a user.
class JsonEntry {
 public:
  using Json = nlohmann::ordered_json;

  static constexpr std::size_t kMostText = 2000;  ///< bytes

  JsonEntry(const Json& value, std::string place) : value_(value), place_(std::move(place)) {}

  const Json& json() const { return value_; }
  const std::string& place() const { return place_; }

  [[noreturn]] void refuse(const std::string& allowed) const;
  void require(bool holds, const std::string& allowed) const {
    if (!holds)
      refuse(allowed);
  }

  /// Requires an object whose keys are all known.
  void require_keys(const std::vector<std::string>& known) const;
  bool has(std::string_view key) const { return value_.is_object() && value_.contains(key); }
  /// Returns the value of a key that the object must have.
  JsonEntry at(const std::string& key) const;
  /// Returns none if the object lacks the key or its value is null.
  std::optional<JsonEntry> find(const std::string& key) const;
  std::vector<JsonEntry> list(const std::string& allowed = "a list") const;

  std::string text(std::size_t most = kMostText) const;
  std::vector<std::string> texts() const;
  /// Requires one of these texts and returns its index.
  std::size_t one_of(const std::vector<std::string>& known) const;
  bool flag() const;
  std::int64_t whole(std::int64_t least = 0, std::int64_t most = std::int64_t{1} << 53U) const;
  /// Returns a number, which must be finite.
  double number(double least = -std::numeric_limits<double>::max(),
                double most = std::numeric_limits<double>::max()) const;

 private:
  const Json& value_;
  std::string place_;
};

/// Parses a text as JSON. Throws InputError "PLACE: found no JSON; allowed: ..." if it is not JSON.
JsonEntry::Json parsed_json(std::string_view text, const std::string& place, const std::string& allowed);

}  // namespace mpm
