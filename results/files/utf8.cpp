#include "results/files/utf8.hpp"

#include <cstdint>
#include <iterator>

#include <utf8.h>

namespace mpm {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

/// `text` as UTF-8 in which each code point that is not `allowed` is U+FFFD.
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

std::string_view cut_utf8(std::string_view text, std::size_t most) {
  if (text.size() <= most)
    return text;
  constexpr unsigned kKind = 0xC0, kContinuation = 0x80;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & kKind) == kContinuation)
    --most;
  return text.substr(0, most);
}

}  // namespace mpm
