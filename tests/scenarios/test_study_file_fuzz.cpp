#include <array>
#include <random>

#include <catch2/catch.hpp>

#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

/// Changes texts at random. The engine's sequence is fixed by the standard, so every run tries the same ones.
class Mutator {
 public:
  std::string mutated(std::string text) {
    for (std::size_t n = below(4) + 1; n > 0; --n) {
      change(text);
    }
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

  void change(std::string& text) {
    static const std::array<std::string, 24> tokens{
        "[",         "]",       "{",   "}",      "=",          "\"",   "\n",    ".",
        ",",         "#",       "-",   "inf",    "-nan",       "1e99", "1e999", "true",
        "\"\"\"abc", "[[x]]\n", "0x7", "[[[[[[", "1979-05-27", "''",   "0",     "\xf0\x9f"};
    if (text.empty()) {
      return;
    }
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

  /// Puts another number in place of the next digit, which leaves a TOML text behind more often than not.
  void change_number(std::string& text, std::size_t place) {
    static const std::array<std::string, 8> numbers{"0",     "-1",          "inf", "nan",
                                                    "1e300", "99999999999", "1.5", "2"};
    const std::size_t digit = text.find_first_of("0123456789", place);
    if (digit != std::string::npos) {
      text.replace(digit, 1, numbers[below(numbers.size())]);
    }
  }

  std::mt19937_64 engine_{1};
};

/// Any other exception than InputError would leave refusal() and fail the test; a crash would end it.
void try_mutations(const std::string& original, int count) {
  Mutator mutator;
  int accepted = 0;
  for (int i = 0; i < count; ++i) {
    const std::string message = refusal(mutator.mutated(original));
    if (message == "accepted") {
      ++accepted;
    } else if (message.rfind("s.toml:", 0) != 0 || message.find("; allowed: ") == std::string::npos) {
      FAIL_CHECK("a refusal without place or rule: " << message);
    }
  }
  // Comments and free numbers can change without harm, most else cannot: a reader that accepts or refuses
  // everything is no reader.
  CHECK(accepted > count / 100);
  CHECK(accepted < count / 2);
}

TEST_CASE("thousands of damaged studies are read or refused", "[study_file]") {
  try_mutations(project_file("scenarios/studies/chapter6.toml"), 3000);
  try_mutations(project_file("scenarios/studies/wood-berry.toml"), 2000);
  try_mutations(small_study(), 2000);
}

TEST_CASE("random bytes are refused", "[study_file]") {
  std::mt19937_64 engine(2);
  for (int i = 0; i < 2000; ++i) {
    std::string text(static_cast<std::size_t>(engine() % 300), '\0');
    for (char& c : text) {
      c = static_cast<char>(engine() % 256);
    }
    const std::string message = refusal(text);
    CHECK(message.rfind("s.toml:", 0) == 0);
  }
}

}  // namespace
}  // namespace mpm
