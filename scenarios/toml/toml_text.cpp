#include "scenarios/toml/toml_text.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "base/error.hpp"
#include "scenarios/toml/toml_literal.hpp"

namespace mpm {
namespace {

constexpr std::size_t kQuotedLength = 40;

[[noreturn]] void refuse(const std::string& file_name, std::size_t line, const std::string& found,
                         const std::string& allowed) {
  throw InputError(fmt::format("{}:{}: TOML", file_name, line), found, allowed);
}

/// The most dots in one piece of a line. Commas, equals signs and opening braces or brackets separate pieces,
/// so that a list of numbers has few dots in each. A quoted part of a key may have commas of its own: a line
/// with quotes counts as one piece.
std::ptrdiff_t most_dots(std::string_view line) {
  const bool quoted = line.find_first_of("\"'") != std::string_view::npos;
  std::ptrdiff_t most = 0, dots = 0;
  for (const char c : line) {
    if (!quoted && (c == ',' || c == '=' || c == '{' || c == '['))
      dots = 0;
    dots += c == '.' ? 1 : 0;
    most = std::max(most, dots);
  }
  return most;
}

void refuse_deep_keys(std::string_view text, const std::string& file_name) {
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::ptrdiff_t dots = most_dots(text.substr(begin, end - begin));
    if (dots > kMaxDotsInKey) {
      refuse(file_name, number, fmt::format("{} dots in one key, or in a line with quotes", dots),
             fmt::format("at most {}", kMaxDotsInKey));
    }
    begin = end + 1;
  }
}

char printable(char c) {
  return c >= ' ' && c <= '~' ? c : '?';
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file_name) {
  if (text.size() > kMaxTomlBytes) {
    refuse(file_name, 1, fmt::format("{} bytes", text.size()), fmt::format("at most {}", kMaxTomlBytes));
  }
  refuse_deep_keys(text, file_name);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    refuse(file_name, error.source().begin.line, std::string(error.description()), "TOML 1.0");
  }
}

std::string in_quotes(std::string_view text) {
  std::string result(text.substr(0, kQuotedLength));
  std::transform(result.begin(), result.end(), result.begin(), printable);
  return fmt::format("'{}{}'", result, text.size() > kQuotedLength ? "..." : "");
}

std::string describe(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return in_quotes(text->get());
  }
  if (const auto* whole = node.as_integer()) {
    return fmt::format("{}", whole->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return toml_literal(number->get());
  }
  if (const auto* flag = node.as_boolean()) {
    return flag->get() ? "true" : "false";
  }
  if (const auto* list = node.as_array()) {
    return fmt::format("a list of {}", list->size());
  }
  return node.is_table() ? "a table" : "a date or time";
}

std::string describe_no_number(const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr)
    return describe(node);
  double number = 0.0;
  const char* const end = text->get().data() + text->get().size();
  const auto read = std::from_chars(text->get().data(), end, number);
  const bool reads_as_number = read.ec == std::errc() && read.ptr == end;
  return fmt::format("the text {}{}", describe(node), reads_as_number ? " (a number has no quotes)" : "");
}

}  // namespace mpm
