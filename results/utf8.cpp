#include "results/utf8.hpp"

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

}  // namespace mpm
