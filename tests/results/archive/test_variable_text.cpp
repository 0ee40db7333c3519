#include <catch2/catch.hpp>

#include "results/archive/variable_text.hpp"
#include "results/files/utf8.hpp"

namespace {

using namespace mpm;

TEST_CASE("variable text: units of time are symbols, which xarray leaves alone, and no unit is 1") {
  CHECK(unit_text("minutes") == "min");
  CHECK(unit_text("seconds") == "s");
  CHECK(unit_text("hours") == "h");
  CHECK(unit_text("days") == "d");
  CHECK(unit_text("min") == "min");
  CHECK(unit_text("") == "1");
}

TEST_CASE("variable text: a unit is common only when all variables have it") {
  CHECK(common_unit({{"a", "K", ""}, {"b", "K", ""}}) == "K");
  CHECK(common_unit({{"a", "K", ""}, {"b", "m", ""}}) == "various");
  CHECK(common_unit({{"a", "", ""}, {"b", "1", ""}}) == "1");
  CHECK(common_unit({}) == "1");
}

TEST_CASE("variable text: positions have the names of the variables as meanings, in one word each") {
  const NumberText text{"cv", "a CV", "1", "", index_words({{"y1", "", ""}, {"top temperature", "", ""}})};
  const Attributes list = attributes<std::int8_t>(text);
  REQUIRE(list.size() == 4);
  CHECK(std::get<std::vector<std::int8_t>>(list[2].second) == std::vector<std::int8_t>{-1, 0, 1});
  CHECK(std::get<std::string>(list[3].second) == "none y1 top_temperature");
  CHECK(value_without_word(text, std::vector<int>{-1, 1}) == nullptr);
  const std::vector<int> values{0, 2};
  CHECK(value_without_word(text, values) == &values[1]);
}

TEST_CASE("utf8: a proper text comes back, any other one becomes proper") {
  const std::string replacement = "\xEF\xBF\xBD";
  CHECK(proper_utf8("") == "");
  CHECK(proper_utf8("a\n\"\\\xC3\xBC\xE6\xB8\xAC\xF0\x9F\x98\x80") ==
        "a\n\"\\\xC3\xBC\xE6\xB8\xAC\xF0\x9F\x98\x80");
  CHECK(proper_utf8("\xFFz") == replacement + "z");
  CHECK(proper_utf8("z\xC3") == "z" + replacement);
  CHECK(proper_utf8("\xE6\xB8z") == replacement + "z");      // cut off
  CHECK(proper_utf8("\xED\xA0\x80z") == replacement + "z");  // a surrogate
  CHECK(proper_utf8("\xC0\xAFz") == replacement + "z");      // '/' in two bytes
  CHECK(proper_utf8(std::string_view("a\0b", 3)) == "a" + replacement + "b");
}

TEST_CASE("plain_text replaces what XML cannot hold and what moves the cursor of a terminal") {
  const std::string replacement = "\xEF\xBF\xBD";
  CHECK(plain_text("a<&>\"'\t\n\xC3\xBC") == "a<&>\"'\t\n\xC3\xBC");
  CHECK(plain_text(std::string_view("\0\x1B[2J\r\x7F", 7)) ==
        replacement + replacement + "[2J" + replacement + replacement);
  CHECK(plain_text("\xEF\xBF\xBE\xEF\xBF\xBF\xFF") == replacement + replacement + replacement);
  // U+202E and U+2066, and their neighbours U+2029, U+202F and U+2065, U+206A
  CHECK(plain_text("a\xE2\x80\xAE\x62\xE2\x81\xA6") == "a" + replacement + "b" + replacement);
  const std::string neighbours = "\xE2\x80\xA9\xE2\x80\xAF\xE2\x81\xA5\xE2\x81\xAA";
  CHECK(plain_text(neighbours) == neighbours);
}

}  // namespace
