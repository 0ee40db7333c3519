#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace mpm {

/// Largest TOML text that is read, in bytes. Study files have some thousand.
inline constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 20;

/// Parses `text`; `file_name` is for messages.
///
/// Errors: InputError "FILE:LINE: TOML: found ...; allowed: ..." for a text that is not TOML (with the
/// parser's message), is longer than kMaxTomlBytes, or has a key with so many dots that tables would nest too
/// deeply.
toml::table parse_toml(std::string_view text, const std::string& file_name);

/// `text` in quotes, fit for one line of a message: shortened, and with '?' for each character that is not
/// printable ASCII.
std::string in_quotes(std::string_view text);

/// What a value is, for messages: "4", "4.0", "'abc'", "a list of 3", "a table".
std::string describe(const toml::node& node);

/// The same for a value where a number is expected: "the text '4.3' (a number has no quotes)".
std::string describe_no_number(const toml::node& node);

}  // namespace mpm
