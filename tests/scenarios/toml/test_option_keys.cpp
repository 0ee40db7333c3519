#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_draft.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

enum class Colour { red, green };

struct Lamp {
  double power = 0.5;
  Colour colour = Colour::green;
  std::vector<int> hours;
};

OptionKeys hour_keys(int& hour) {
  return {key::whole("hour", hour, 0, 23, "when it is lit").required()};
}

OptionKeys keys(Lamp& lamp) {
  return {key::number("power", lamp.power, NumberRule::below_one(), "of its [bulb](bulbs.md), `P`", "kW"),
          key::choice("colour", lamp.colour, {"red", "green"}, "what it shows"),
          key::check([&lamp](const TomlTable& table) {
            if (lamp.colour == Colour::red && lamp.power == 0.0)
              table.refuse("power", "0 for a red lamp", "more");
          }),
          key::list<int>(
              "lit", 2, hour_keys, [&lamp](const TomlTable&, int& hour) { lamp.hours.push_back(hour); },
              "the hours")};
}

Lamp read_lamp(const char* text) {
  const toml::table toml = parse_toml(text, "lamp.toml");
  Lamp lamp;
  return read_options<Lamp>(TomlTable(toml, "lamp.toml", key_names(keys(lamp))));
}

TEST_CASE("keys are read into the members that they are declared with", "[option_keys]") {
  const Lamp lamp = read_lamp("lit = [{hour = 3}, {hour = 5}]\ncolour = 'red'");
  CHECK(lamp.power == 0.5);
  CHECK(lamp.colour == Colour::red);
  CHECK(lamp.hours == std::vector<int>{3, 5});
  CHECK_THROWS_WITH(read_lamp("power = 1"), "lamp.toml:1: power: found 1; allowed: a number in [0, 1)");
  CHECK_THROWS_WITH(read_lamp("\npower = 0\ncolour = 'red'"),
                    "lamp.toml:2: power: found 0 for a red lamp; allowed: more");
  CHECK_THROWS_WITH(read_lamp("lit = [{}]"), Contains("lit[0].hour: found nothing"));
  CHECK_THROWS_WITH(read_lamp("lit = [{hour = 1}, {hour = 1}, {hour = 1}]"), Contains("allowed: at most 2"));
  CHECK_THROWS_WITH(read_lamp("powr = 1"), Contains("unknown key 'powr' (nearest: 'power')"));
}

TEST_CASE("the manual has a row for each key, with the default of its member", "[option_keys]") {
  Lamp lamp;
  const std::vector<KeyTable> tables = key_tables("lamp", keys(lamp));
  REQUIRE(tables.size() == 2);
  CHECK(manual_table(tables[0].keys) ==
        "| key | type | unit | default | allowed | meaning |\n"
        "|---|---|---|---|---|---|\n"
        "| `power` | number | kW | 0.5 | 0 to below 1 | of its [bulb](bulbs.md), `P` |\n"
        "| `colour` | text | | `\"green\"` | `\"red\"`, `\"green\"` | what it shows |\n"
        "| `lit` | list of tables | | none | | the hours |\n");
  CHECK(tables[1].name == "lamp.lit[]");
  CHECK(manual_table(tables[1].keys) ==
        "| key | type | default | allowed | meaning |\n"
        "|---|---|---|---|---|\n"
        "| `hour` | whole number | required | 0 to 23 | when it is lit |\n");
}

TEST_CASE("a draft explains a key where it comes first", "[option_keys]") {
  Lamp lamp;
  int hour = 0;
  const OptionKeys of_lamp = keys(lamp), of_hour = hour_keys(hour);
  TomlDraft draft(key_names(of_lamp));
  draft.explain("lamp", plain_meanings(of_lamp));
  draft.set("power", 0.25);
  for (std::size_t i = 0; i < 2; ++i)
    draft.table_in_list("lit", i, key_names(of_hour)).explain("lit", plain_meanings(of_hour)).set("hour", 4);
  CHECK(draft.text() ==
        "# of its bulb, P [kW]; allowed: 0 to below 1\npower = 0.25\n\n# the hours\n[[lit]]\n"
        "# when it is lit; allowed: 0 to 23\nhour = 4\n\n[[lit]]\nhour = 4\n");
}

}  // namespace
