#include "base/system/foreign_text.hpp"

namespace mpm {

std::string foreign_text(std::string_view text, std::size_t most) {
  const bool all = text.size() <= most;
  std::string line;
  for (const char c : text.substr(0, most))
    line += c == '\n' || c == '\t' ? ' ' : c >= ' ' && c <= '~' ? c : '?';
  const auto begin = line.find_first_not_of(' ');
  if (begin == std::string::npos)
    return "";
  return line.substr(begin, line.find_last_not_of(' ') - begin + 1) + (all ? "" : "...");
}

}  // namespace mpm
