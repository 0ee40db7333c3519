#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "scenarios/toml/nearest_name.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

using Names = std::vector<std::string>;

TEST_CASE("names that are near come first, and far ones not at all", "[nearest_name]") {
  const Names names = {"located", "detected", "rejected", "selected", "score"};
  CHECK(nearest_names("detekted", names, 9) == Names{"detected", "rejected", "selected"});
  CHECK(nearest_names("detekted", names, 1) == Names{"detected"});
  CHECK(nearest_name("selekted", names) == "selected");
  CHECK(nearest_name("x", names).empty());
  CHECK(nearest_name(std::string(100, 'd'), names).empty());  // no misspelling is as long
}

TEST_CASE("of a long list the nearest three are named", "[nearest_name]") {
  Names names = {"mpm.located", "ud.located", "cv.located", "bd.located"};
  CHECK(with_nearest("mpm.locatde", names) == "'mpm.locatde' (nearest: 'mpm.located')");
  CHECK(with_nearest("what", names) == "'what'");
  for (int i = 0; i < 40; ++i)
    names.push_back("rate." + std::to_string(1000 + i));
  CHECK(with_nearest("mpm.locatde", names) ==
        "'mpm.locatde' (nearest: 'mpm.located', 'ud.located', 'cv.located')");
}

}  // namespace
}  // namespace mpm
