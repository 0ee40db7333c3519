#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/system/json_entry.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

const JsonEntry::Json kJson = {{"text", "a\"b"},  {"flag", true},        {"whole", 3},
                               {"half", 0.5},     {"none", nullptr},     {"list", {"x", "y"}},
                               {"bytes", "\xFF"}, {"object", {{"k", 1}}}};

TEST_CASE("JSON of others: what is asked for is read") {
  const JsonEntry entry(kJson, "f.json");
  entry.require_keys({"text", "flag", "whole", "half", "none", "list", "bytes", "object"});
  CHECK(entry.at("text").text() == "a\"b");
  CHECK(entry.at("flag").flag());
  CHECK(entry.at("whole").whole() == 3);
  CHECK(entry.at("whole").number() == 3.0);
  CHECK(entry.at("half").number(0.0, 1.0) == 0.5);
  CHECK(entry.at("list").texts() == std::vector<std::string>{"x", "y"});
  CHECK(entry.at("list").list()[1].one_of({"z", "y"}) == 1);
  CHECK(entry.at("object").at("k").place() == "f.json: object: k");
  CHECK_FALSE(entry.find("none").has_value());
  CHECK_FALSE(entry.find("missing").has_value());
  CHECK(parsed_json("[1]", "here", "a list").size() == 1);
}

TEST_CASE("JSON of others: everything else is refused with its place, and in no words of the library") {
  const JsonEntry entry(kJson, "f.json");
  const std::vector<std::pair<std::function<void()>, std::string>> refused{
      {[&] { entry.at("missing"); }, "f.json: found no 'missing'; allowed: an object with it"},
      {[&] { entry.at("text").at("k"); }, "f.json: text: found \"a\\\"b\"; allowed: an object with 'k'"},
      {[&] { entry.require_keys({"text"}); }, "f.json: found the unknown key 'flag'; allowed: text"},
      {[&] { entry.at("list").require_keys({}); }, "f.json: list: found a list of 2; allowed: an object"},
      {[&] { entry.at("object").list(); }, "f.json: object: found an object of 1; allowed: a list"},
      {[&] { entry.at("text").texts(); }, "f.json: text: found \"a\\\"b\"; allowed: a list of texts"},
      {[&] { entry.at("whole").text(); }, "f.json: whole: found 3; allowed: a text"},
      {[&] { entry.at("text").text(2); }, "f.json: text: found a text of 3 bytes; allowed: at most 2"},
      {[&] { entry.at("whole").flag(); }, "f.json: whole: found 3; allowed: true or false"},
      {[&] { entry.at("half").whole(); }, "f.json: half: found 0.5; allowed: a whole number from 0 to "},
      {[&] { entry.at("whole").whole(0, 2); }, "f.json: whole: found 3; allowed: a whole number from 0 to 2"},
      {[&] { entry.at("whole").number(0.0, 1.0); }, "f.json: whole: found 3; allowed: a number from 0 to 1"},
      {[&] { entry.at("none").number(); }, "f.json: none: found null; allowed: a finite number"},
      {[&] { entry.at("bytes").flag(); }, "f.json: bytes: found \"\\ufffd\"; allowed: true or false"},
      {[&] {
         entry.at("text").one_of({"x", "y"});
       },
       "f.json: text: found \"a\\\"b\"; allowed: x, y"},
      {[&] { parsed_json("{", "f.json", "an object"); }, "f.json: found no JSON; allowed: an object"},
  };
  for (const std::pair<std::function<void()>, std::string>& each : refused) {
    CHECK_THROWS_AS(each.first(), InputError);
    CHECK_THROWS_WITH(each.first(), Contains(each.second));
  }
}

}  // namespace
