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

/// A value of JSON that somebody else has written, and its place for messages: "FILE: cells[3]: study". It
/// must live as long as what is read from it.
///
/// Each member function that asks for something throws InputError "PLACE: found ...; allowed: ..." where it
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

  /// An object with no other keys than these.
  void require_keys(const std::vector<std::string>& known) const;
  bool has(std::string_view key) const { return value_.is_object() && value_.contains(key); }
  /// The value of a key that an object must have.
  JsonEntry at(const std::string& key) const;
  /// None where the object lacks the key or its value is null.
  std::optional<JsonEntry> find(const std::string& key) const;
  std::vector<JsonEntry> list(const std::string& allowed = "a list") const;

  std::string text(std::size_t most = kMostText) const;
  std::vector<std::string> texts() const;
  /// The place of the text among these.
  std::size_t one_of(const std::vector<std::string>& known) const;
  bool flag() const;
  std::int64_t whole(std::int64_t least = 0, std::int64_t most = std::int64_t{1} << 53U) const;
  /// A finite one.
  double number(double least = -std::numeric_limits<double>::max(),
                double most = std::numeric_limits<double>::max()) const;

 private:
  const Json& value_;
  std::string place_;
};

/// Parses a text as JSON. Throws InputError "PLACE: found no JSON; allowed: ..." for any other text.
JsonEntry::Json parsed_json(std::string_view text, const std::string& place, const std::string& allowed);

}  // namespace mpm
