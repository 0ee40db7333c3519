#include "results/files/utf8.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include <utf8.h>

namespace mpm {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

/// Returns `text` as UTF-8, with U+FFFD for each code point that is not `allowed`.
template <class Allowed>
std::string replaced(std::string_view text, Allowed allowed) {
  std::string valid;
  utf8::replace_invalid(text.begin(), text.end(), std::back_inserter(valid), kReplacement);
  std::string result;
  for (auto at = valid.cbegin(); at != valid.cend();) {
    const std::uint32_t code = utf8::unchecked::next(at);
    utf8::unchecked::append(allowed(code) ? code : kReplacement, std::back_inserter(result));
  }
  return result;
}

bool is_surrogate(std::uint32_t unit, std::uint32_t first) {
  constexpr std::uint32_t kSurrogates = 0x400;
  return unit >= first && unit < first + kSurrogates;
}

}  // namespace

std::string proper_utf8(std::string_view text) {
  return replaced(text, [](std::uint32_t code) { return code != 0; });
}

std::string plain_text(std::string_view text) {
  return replaced(text, [](std::uint32_t code) {
    const bool control = (code < 0x20 && code != '\t' && code != '\n') || (code >= 0x7F && code < 0xA0);
    const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return !control && !turns && code != 0xFFFE && code != 0xFFFF;
  });
}

bool is_utf16(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("\xFE\xFF"sv) ||
         (bytes.size() > 1 && (bytes[0] == '\0') != (bytes[1] == '\0'));
}

std::string utf8_of_utf16(std::string_view bytes) {
  constexpr std::uint32_t kMark = 0xFEFF, kHigh = 0xD800, kLow = 0xDC00;
  const bool big_endian = bytes.starts_with("\xFE\xFF") || (!bytes.empty() && bytes[0] == '\0');
  std::vector<std::uint16_t> units;
  for (std::size_t at = 0; at < bytes.size(); at += 2) {
    const bool half = at + 1 == bytes.size();
    const auto one = static_cast<unsigned char>(bytes[at]);
    const auto other = static_cast<unsigned char>(half ? 0 : bytes[at + 1]);
    const unsigned unit = big_endian ? 256U * one + other : 256U * other + one;
    if (at != 0 || unit != kMark)
      units.push_back(static_cast<std::uint16_t>(half ? kReplacement : unit));
  }
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (is_surrogate(units[i], kHigh) && i + 1 < units.size() && is_surrogate(units[i + 1], kLow))
      ++i;
    else if (is_surrogate(units[i], kHigh) || is_surrogate(units[i], kLow))
      units[i] = static_cast<std::uint16_t>(kReplacement);
  }
  std::string text;
  utf8::utf16to8(units.begin(), units.end(), std::back_inserter(text));
  return text;
}

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view cut_utf8(std::string_view text, std::size_t most) {
  if (text.size() <= most)
    return text;
  constexpr unsigned kKind = 0xC0, kContinuation = 0x80;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & kKind) == kContinuation)
    --most;
  return text.substr(0, most);
}

}  // namespace mpm
