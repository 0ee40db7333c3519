#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/enum_words.hpp"
#include "base/row.hpp"

namespace mpm {

enum class Colour : std::int8_t { red, light_blue };
template <>
inline constexpr auto kWords<Colour> = word_list("red", "light blue");

namespace {

struct Part {
  double size = 1.5;
  int count = 3;
  Colour colour = Colour::red;
  Eigen::VectorXd values = {};
};

struct Whole {
  Part part;
  std::vector<Part> parts;
};

TEST_CASE("enum words: a word for each value, a value for each word, and none for another") {
  CHECK(to_string(Colour::light_blue) == "light blue");
  CHECK(to_string(static_cast<Colour>(2)) == "unknown");
  CHECK(to_string(static_cast<Colour>(-1)) == "unknown");
  CHECK(enumerator<Colour>("light blue") == Colour::light_blue);
  CHECK_FALSE(enumerator<Colour>("light_blue"));
  CHECK(enumerators<Colour>().back() == Colour::light_blue);
  const std::vector<NumberWord> words = enum_words<Colour>();
  REQUIRE(words.size() == 2);
  CHECK(*word_for(words, 1) == "light blue");
  CHECK(word_for(words, 2) == nullptr);
}

TEST_CASE("row: a part's is one of the whole, and one of many parts has a dimension more") {
  const Row<Part> size = member_row<double>({"size", "size of a part", "m"}, &Part::size).from_version(4);
  Whole whole{{}, {{.size = 1.0}, {.size = 2.0}}};
  const Row<Whole> one = of_part<Whole>(size, &Whole::part);
  CHECK(one.since == 4);
  CHECK(one.text.unit == "m");
  CHECK(numbers_of(one, whole) == std::vector<double>{1.5});
  const Row<Whole> each = of_each<Whole>(size, "place", 2, &Whole::parts);
  CHECK(each.dimensions == std::vector<std::string>{"place"});
  CHECK(numbers_of(each, whole) == std::vector<double>{1.0, 2.0});
  const std::vector<double> other{5.0, 6.0};
  Whole empty;
  put_numbers(each, empty, other.data());
  REQUIRE(empty.parts.size() == 2);
  CHECK(empty.parts[1].size == 6.0);
}

TEST_CASE("row: what a whole number or an enumeration cannot be leaves it as it is") {
  const auto count = member_row<double, Part>({"count", "number of things"}, &Part::count);
  const auto colour =
      member_row<std::int8_t>({"colour", "its colour", "1", "", enum_words<Colour>()}, &Part::colour);
  Part part;
  for (const double value : {kNaN, kInfinity, -1e300}) {
    put_numbers(count, part, &value);
    CHECK(part.count == 3);
  }
  const double seven = 7.0, one = 1.0;
  put_numbers(count, part, &seven);
  CHECK(part.count == 7);
  put_numbers(colour, part, &seven);
  put_numbers(colour, part, &kNaN);
  CHECK(part.colour == Colour::red);
  put_numbers(colour, part, &one);
  CHECK(part.colour == Colour::light_blue);
}

TEST_CASE("row: a vector that is empty is NaN in a file") {
  const auto values = vector_row<Part>({"values", "some values"}, "place", 2, &Part::values);
  Part part;
  for (const double value : numbers_of(values, part))
    CHECK(std::isnan(value));
  const std::vector<double> numbers{1.0, 2.0};
  put_numbers(values, part, numbers.data());
  CHECK(part.values == Eigen::Vector2d(1.0, 2.0));
}

}  // namespace
}  // namespace mpm
