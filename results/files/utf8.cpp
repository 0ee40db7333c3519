#include "results/files/utf8.hpp"

#include <nlohmann/json.hpp>

namespace mpm {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

}  // namespace

std::string proper_utf8(std::string_view text) {
  using nlohmann::json;
  // The JSON library replaces what is no UTF-8 when it writes a text.
  const std::string quoted = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  const auto valid = json::parse(quoted).get<std::string>();
  std::string proper;
  proper.reserve(valid.size());
  for (const char c : valid) {
    if (c == '\0')
      proper += kReplacement;
    else
      proper += c;
  }
  return proper;
}

std::string plain_text(std::string_view text) {
  std::string result;
  for (const char c : proper_utf8(text)) {
    const auto code = static_cast<unsigned char>(c);
    const bool control = (code < 0x20 && c != '\t' && c != '\n') || code == 0x7F;
    result += control ? std::string(kReplacement) : std::string(1, c);
  }
  for (const std::string_view none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})  // U+FFFE, U+FFFF
    for (std::size_t at = result.find(none); at != std::string::npos; at = result.find(none, at))
      result.replace(at, none.size(), kReplacement);
  return result;
}

}  // namespace mpm
