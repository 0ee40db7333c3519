#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/board_rerun.hpp"
#include "analysis/findings/world_counts.hpp"

namespace mpm {
namespace {

/// A board of one cell: of each method the loops of eight worlds that it finds, ten a world.
Leaderboard board_of(const std::vector<std::pair<std::string, std::int64_t>>& found_in_world) {
  Suite suite;
  suite.plants = {{"a", ""}};
  suite.families = {{"f", ""}};
  CellScores cell;
  std::vector<std::string> names;
  for (const auto& [name, found] : found_in_world) {
    WorldCount count;
    for (int world = 0; world < 8; ++world)
      count.add(world, ClusterCount{found + world % 2, 10});
    names.push_back(name);
    cell.methods.emplace_back().rates["power_05_impact"] = count.rate(0.95);
  }
  return make_leaderboard(suite, names, "1.0", {cell});
}

}  // namespace

TEST_CASE("a rerun tells a table of right answers from what a method answers", "[leaderboard]") {
  const std::vector<std::string_view> rates{"power_05_impact", "answered"};
  const Leaderboard stated = board_of({{"honest", 6}, {"boast", 9}, {"absent", 6}}),
                    again = board_of({{"boast", 4}, {"honest", 6}});
  const std::vector<RerunRate> found = rerun_rates(stated, again, rates);
  REQUIRE(found.size() == 2);  // of methods in both, and of what was counted
  CHECK((found[0].method == "honest" && found[1].method == "boast"));
  CHECK(found[0].difference.value == 0.0);
  CHECK_FALSE(found[0].differs(0.05));
  CHECK(found[1].difference.value == Approx(-0.5));
  CHECK(found[1].differs(0.05));
  CHECK(found[1].p_holm >= found[1].difference.p);
  CHECK(rerun_rates(stated, board_of({{"else", 1}}), rates).empty());
}

}  // namespace mpm
