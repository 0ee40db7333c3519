#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <toml++/toml.h>

#include "scenarios/random/random_stream.hpp"
#include "scenarios/toml/toml_draft.hpp"
#include "scenarios/toml/toml_literal.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

template <class Value>
Value read_back(const std::string& literal) {
  const toml::table table = parse_toml("x = " + literal, "s.toml");
  const std::optional<Value> value = table.get("x")->value_exact<Value>();
  REQUIRE(value.has_value());
  return *value;
}

bool comes_back(double value) {
  return std::bit_cast<std::uint64_t>(read_back<double>(toml_literal(value))) ==
         std::bit_cast<std::uint64_t>(value);
}

TEST_CASE("every number comes back to the last bit", "[toml_literal]") {
  using Number = std::numeric_limits<double>;
  for (const double value :
       {0.0, -0.0, 1.0, -2.0, 0.1, 1.0 / 3.0, 1e22, 1e23, 123456789012345680.0, 1e-9, Number::max(),
        Number::min(), Number::denorm_min(), Number::epsilon(), Number::infinity(), -Number::infinity()})
    CHECK(comes_back(value));
  CHECK(std::isnan(read_back<double>(toml_literal(Number::quiet_NaN()))));
  RandomStream stream(20150401, 0, StreamId::measurement_noise);
  for (int i = 0; i < 5000; ++i)
    if (const double value = std::ldexp(stream.normal(), static_cast<int>(600 * stream.normal()));
        !comes_back(value))
      FAIL_CHECK("does not come back: " << value);
  CHECK(read_back<std::int64_t>(toml_literal(std::numeric_limits<std::int64_t>::max())) ==
        std::numeric_limits<std::int64_t>::max());
  CHECK(read_back<bool>(toml_literal(true)));
}

TEST_CASE("every text comes back", "[toml_literal]") {
  std::string every_ascii;
  for (char c = 1; c > 0 && c < 127; ++c)
    every_ascii += c;
  for (const std::string& text :
       {std::string(), every_ascii, std::string("\x7f\0", 2), std::string("\xc3\xa4 \xe2\x82\xac"),
        std::string("say \"no\" to \\n"), std::string(1000, '.')})
    CHECK(read_back<std::string>(toml_literal(text)) == text);
}

TEST_CASE("a long list of numbers comes back, on lines that the reader takes", "[toml_literal]") {
  for (const Eigen::Index size : {1, 50, 51, 100, 1000}) {
    const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(size, 0.1, 7.3);
    const toml::table table = parse_toml("x = " + toml_literal(numbers), "s.toml");
    const toml::array& list = *table.get_as<toml::array>("x");
    REQUIRE(list.size() == static_cast<std::size_t>(size));
    for (Eigen::Index i = 0; i < size; ++i)
      CHECK(list[static_cast<std::size_t>(i)].value<double>() == numbers(i));
  }
  CHECK(toml_literal(std::vector<int>{3, 4}) == "[3, 4]");
  CHECK(toml_literal(std::vector<std::string>{}) == "[]");
}

TEST_CASE("distributions are inline tables", "[toml_literal]") {
  CHECK(toml_literal(Distribution::constant(2)) == "{constant = 2.0}");
  CHECK(toml_literal(Distribution::uniform(-2, 2)) == "{uniform = [-2.0, 2.0]}");
  CHECK(toml_literal(Distribution::log_uniform(0.05, 20)) == "{log_uniform = [0.05, 20.0]}");
  CHECK(toml_literal(Distribution::normal(0, 1e-9)) == "{normal = [0.0, 1e-09]}");
}

TEST_CASE("a draft is written in its order of keys, values before tables", "[toml_draft]") {
  TomlDraft draft({"a", "b", "c.d", "e"});
  draft.table("a", {"x", "y"}).set("y", 1);
  draft.table("a", {"x", "y"}).set("x", 0.5);
  draft.table_in_list("b", 0, {"z"});
  draft.table_in_list("b", 1, {"z"}).table("z", {"k"}).set("k", "text");
  draft.set("c.d", true);
  draft.set("c.d", false);
  draft.table("e", {"empty"});
  CHECK(draft.text() == "\"c.d\" = false\n\n[a]\nx = 0.5\ny = 1\n\n[[b]]\n\n[[b]]\n\n[b.z]\nk = \"text\"\n");
  CHECK(TomlDraft({}).text().empty());
}

TEST_CASE("a value in a draft stands in place of tables under its key", "[toml_draft]") {
  TomlDraft draft({"a", "b"});
  draft.table("a", {"x"}).set("x", 1);
  draft.set("a", 2);
  draft.comment("b", "no value");
  CHECK(draft.text() == "a = 2\n# b: no value\n");
}

}  // namespace
}  // namespace mpm
