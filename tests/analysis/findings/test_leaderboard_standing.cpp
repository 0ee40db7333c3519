#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/leaderboard_standing.hpp"

namespace mpm {
namespace {

constexpr OutcomeScope kPower{.at_05 = true};

/// One plant and one family.
Suite one_cell() {
  Suite suite;
  suite.name = "s";
  suite.plants = {{"a", ""}};
  suite.families = {{"f", ""}};
  return suite;
}

/// A method above the threshold on the first `hits` loops of `loops`, all of which have a mismatch with an
/// impact.
LoopOutcomes above_on_first(std::size_t hits, std::size_t loops) {
  LoopOutcomes outcomes(loops, LoopOutcome{.answered = true});
  std::fill_n(outcomes.begin(), hits, LoopOutcome{.answered = true, .above_05 = true});
  return outcomes;
}

Leaderboard board_of(const std::vector<std::string>& names, const std::vector<LoopOutcomes>& outcomes,
                     const std::vector<OutcomeScope>& scopes) {
  const std::size_t loops = outcomes.front().size();
  CellScores cell{.truths = LoopTruths(loops, FaultTruth{ExperimentKind::mpm, true, true}),
                  .worlds = std::vector<int>(loops, 0)};
  for (std::size_t i = 0; i < names.size(); ++i)
    cell.methods.push_back(scores_of_outcomes(cell, outcomes[i], scopes[i]));
  return make_leaderboard(one_cell(), names, "1.0", {cell});
}

}  // namespace

TEST_CASE("the outcomes of a cell make its rates", "[leaderboard]") {
  const Leaderboard board = board_of({"m"}, {above_on_first(30, 40)}, {kPower});
  CHECK(board.overall[0]["power_05_impact"].hits == 30);
  CHECK(board.overall[0]["power_05_impact"].total == 40);
  CHECK(board.overall[0]["answered"].hits == 40);
  CHECK(board.overall[0]["detected"].hits == 0);
  CHECK(board.overall[0]["source_all"].total == 0);  // it tells no sources
}

TEST_CASE("a method is paired with the others on the same loops", "[leaderboard]") {
  const Leaderboard board = board_of({"weak", "mine", "near", "silent", "ceiling"},
                                     {above_on_first(10, 40), above_on_first(30, 40), above_on_first(31, 40),
                                      above_on_first(40, 40), above_on_first(40, 40)},
                                     {kPower, kPower, kPower, {}, kPower});
  const auto standing = standing_of(board, 1);
  REQUIRE(standing);
  CHECK(standing->rate == "power_05_impact");
  REQUIRE(standing->duels.size() == 2);  // neither one without a threshold nor the reference
  CHECK(standing->duels[0].other == 2);
  CHECK(standing->duels[0].difference.value == Approx(-1.0 / 40));
  CHECK_FALSE(standing->duels[0].lost());
  CHECK(standing->duels[1].other == 0);
  CHECK(standing->duels[1].difference.value == Approx(0.5));
  CHECK(standing->duels[1].loops == 40);
  CHECK(standing->won() == 1);
  CHECK(standing->lost() == 0);
  CHECK(standing->place == 2);
  CHECK_FALSE(standing_of(board, 3));
}

TEST_CASE("a duel is won beyond chance among all duels of a method", "[leaderboard]") {
  // 10 of 40 loops more is p = 0.002: beyond chance of one duel or of ten, not of thirty.
  for (const std::size_t others : {1, 10, 30}) {
    std::vector<std::string> names{"mine"};
    std::vector<LoopOutcomes> outcomes{above_on_first(30, 40)};
    for (std::size_t i = 0; i < others; ++i) {
      names.push_back("other" + std::to_string(i));
      outcomes.push_back(above_on_first(20, 40));
    }
    const auto standing =
        standing_of(board_of(names, outcomes, std::vector<OutcomeScope>(names.size(), kPower)), 0);
    REQUIRE(standing);
    CHECK(standing->duels.front().difference.interval.lower > 0.0);
    CHECK(standing->won() == (others < 30 ? static_cast<int>(others) : 0));
  }
}

TEST_CASE("loops that one of two methods has not seen do not pair them", "[leaderboard]") {
  LoopOutcomes half = above_on_first(40, 40);
  std::fill_n(half.begin(), 20, std::nullopt);
  const Leaderboard board = board_of({"half", "mine"}, {half, above_on_first(30, 40)}, {kPower, kPower});
  const auto standing = standing_of(board, 1);
  REQUIRE(standing);
  CHECK(standing->duels[0].loops == 20);
  CHECK(standing->duels[0].difference.value == Approx(-0.5));  // 10 of the last 20 against 20
  CHECK(standing->lost() == 1);
  CHECK(board.overall[0]["answered"].total == 20);
}

}  // namespace mpm
