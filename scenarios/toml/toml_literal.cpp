#include "scenarios/toml/toml_literal.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "base/enum_words.hpp"

namespace mpm {
namespace {

constexpr std::size_t kNumbersOnLine = 50;  // fewer than kMaxDotsInKey, the dots that parse_toml() takes

bool may_stand_in_bare_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

template <class Values>
std::string list_of(const Values& values) {
  const auto count = static_cast<std::size_t>(values.size());
  const bool broken = count > kNumbersOnLine;
  std::string text = "[";
  std::size_t i = 0;
  for (const auto& value : values) {
    if (broken && i % kNumbersOnLine == 0)
      text += "\n  ";
    text += toml_literal(value);
    if (++i < count)
      text += broken && i % kNumbersOnLine == 0 ? "," : ", ";
  }
  return text + (broken ? "\n]" : "]");
}

std::string_view kind_name(Distribution::Kind kind) {
  constexpr auto kNames = word_list("constant", "uniform", "log_uniform", "normal");
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace

std::string toml_literal(double value) {
  std::string text = fmt::format("{}", value);  // the shortest text that comes back as the same number
  if (text.find_first_not_of("-0123456789") == std::string::npos)
    text += ".0";
  return text;
}

std::string toml_literal(std::int64_t value) {
  return fmt::format("{}", value);
}

std::string toml_literal(int value) {
  return fmt::format("{}", value);
}

std::string toml_literal(bool value) {
  return value ? "true" : "false";
}

std::string toml_literal(std::string_view text) {
  // A text of several lines may have more dots than parse_toml() takes on one.
  const bool too_many_dots = std::count(text.begin(), text.end(), '.') > kMaxDotsInKey;
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      quoted += {'\\', c};
    else if (code < 0x20 || code == 0x7f || (c == '.' && too_many_dots))
      quoted += fmt::format("\\u{:04X}", code);
    else
      quoted += c;
  }
  return quoted + '"';
}

std::string toml_literal(const std::string& text) {
  return toml_literal(std::string_view(text));
}

std::string toml_literal(const char* text) {
  return toml_literal(std::string_view(text));
}

std::string toml_literal(const Eigen::VectorXd& numbers) {
  return list_of(numbers);
}

std::string toml_literal(const std::vector<int>& numbers) {
  return list_of(numbers);
}

std::string toml_literal(const std::vector<std::string>& texts) {
  return list_of(texts);
}

std::string toml_literal(const std::pair<double, double>& pair) {
  return fmt::format("[{}, {}]", toml_literal(pair.first), toml_literal(pair.second));
}

std::string toml_literal(const Distribution& distribution) {
  return fmt::format("{{{} = {}}}", kind_name(distribution.kind()),
                     distribution.kind() == Distribution::Kind::constant
                         ? toml_literal(distribution.first())
                         : toml_literal(std::pair(distribution.first(), distribution.second())));
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), may_stand_in_bare_key);
  return bare ? std::string(key) : toml_literal(key);
}

}  // namespace mpm
