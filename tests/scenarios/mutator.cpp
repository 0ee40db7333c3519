#include "tests/scenarios/mutator.hpp"

#include <array>

namespace mpm::testing {

std::string Mutator::mutated_toml(std::string text) {
  for (std::size_t n = below(4) + 1; n > 0; --n)
    change_toml(text);
  return text;
}

std::string Mutator::mutated_bytes(std::string content) {
  for (std::size_t n = below(4) + 1; n > 0; --n)
    change_bytes(content);
  return content;
}

std::string Mutator::random_bytes(std::size_t longest) {
  std::string bytes(below(longest + 1), '\0');
  for (char& byte : bytes)
    byte = static_cast<char>(below(256));
  return bytes;
}

void Mutator::change_toml(std::string& text) {
  static const std::array<std::string, 24> tokens{
      "[",         "]",       "{",   "}",      "=",          "\"",   "\n",    ".",
      ",",         "#",       "-",   "inf",    "-nan",       "1e99", "1e999", "true",
      "\"\"\"abc", "[[x]]\n", "0x7", "[[[[[[", "1979-05-27", "''",   "0",     "\xf0\x9f"};
  if (text.empty())
    return;
  const std::size_t place = below(text.size());
  const std::size_t length = below(40);
  switch (below(5)) {
    case 0:
      text[place] = static_cast<char>(below(256));
      break;
    case 1:
      text.erase(place, length);
      break;
    case 2:
      text.insert(below(text.size()), text.substr(place, length));
      break;
    case 3:
      text.insert(place, tokens[below(tokens.size())]);
      break;
    default:
      change_number(text, place);
  }
}

void Mutator::change_number(std::string& text, std::size_t place) {
  static const std::array<std::string, 8> numbers{"0",     "-1",          "inf", "nan",
                                                  "1e300", "99999999999", "1.5", "2"};
  const std::size_t digit = text.find_first_of("0123456789", place);
  if (digit != std::string::npos)
    text.replace(digit, 1, numbers[below(numbers.size())]);
}

void Mutator::change_bytes(std::string& content) {
  if (content.empty())
    return;
  const std::size_t place = below(content.size());
  const std::size_t length = 1 + below(4096);
  switch (below(6)) {
    case 0:
      content[place] = static_cast<char>(content[place] ^ (1 << below(8)));
      break;
    case 1:
      content[place] = static_cast<char>(below(256));
      break;
    case 2:
      content.erase(place, length);
      break;
    case 3:
      content.insert(below(content.size()), content.substr(place, length));
      break;
    case 4:
      content.replace(place, length, length, static_cast<char>(below(256)));
      break;
    default:
      content.resize(place);
  }
}

}  // namespace mpm::testing
