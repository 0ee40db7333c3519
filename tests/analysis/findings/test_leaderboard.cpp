#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/statistics/clustered_rate.hpp"

namespace mpm {
namespace {

using HitsOf = std::map<std::string, std::pair<std::int64_t, std::int64_t>>;  // hits and total by name

MethodScores scores_with(const HitsOf& hits_of) {
  MethodScores scores;
  for (const auto& [name, hits] : hits_of)
    scores.rates[name] = rate(hits.first, hits.second);
  return scores;
}

PooledScores pooled_with(const HitsOf& hits_of) {
  PooledScores pooled;
  pooled.rates = scores_with(hits_of).rates;
  return pooled;
}

/// A suite of plants a, b, c and families f, g without studies, which pooling does not look at.
Suite two_families() {
  Suite suite;
  suite.name = "s";
  suite.plants = {{"a", ""}, {"b", ""}, {"c", ""}};
  suite.families = {{"f", ""}, {"g", ""}};
  return suite;
}

const HitsOf kSound{{"answered", {100, 100}},
                    {"detected_impact", {80, 100}},
                    {"false_alarm_healthy", {2, 20}},
                    {"located", {8, 10}},
                    {"source", {8, 10}},
                    {"source_all", {8, 10}}};

HitsOf with(HitsOf hits_of, const std::string& name, std::int64_t hits, std::int64_t total) {
  hits_of[name] = {hits, total};
  return hits_of;
}

}  // namespace

TEST_CASE("loops of the cells are added up, by family, by plant and over all", "[leaderboard]") {
  const Leaderboard board =
      make_leaderboard(two_families(), {"m"}, "1.0",
                       {{.plant = 0,
                         .family = 0,
                         .methods = {scores_with({{"detected_impact", {1, 4}}, {"answered", {5, 5}}})}},
                        {.plant = 2,
                         .family = 0,
                         .methods = {scores_with({{"detected_impact", {9, 12}}, {"answered", {0, 6}}})}},
                        {.plant = 2, .family = 1, .methods = {scores_with({{"detected_impact", {0, 4}}})}}});
  REQUIRE(board.plants.size() == 2);  // b has no cell
  CHECK(board.plants[1].name == "c");
  CHECK(board.cells[1].plant == 1);
  const Rate& f = board.by_family[0][0]["detected_impact"];
  CHECK(f.hits == 10);
  CHECK(f.total == 16);
  CHECK(f.value == 0.625);
  // Wilson's interval of 10 of 16, from its formula with z = 1.95996.
  CHECK(f.interval.lower == Approx(0.38641).margin(1e-5));
  CHECK(f.interval.upper == Approx(0.81519).margin(1e-5));
  CHECK(board.by_family[0][0].cells == 2);
  CHECK(board.by_family[0][0].answering_cells == 1);
  CHECK(board.by_plant[0][1]["detected_impact"].hits == 9);
  CHECK(board.by_plant[0][1]["detected_impact"].total == 16);
  CHECK(board.overall[0]["detected_impact"].total == 20);
  CHECK_THROWS_AS(board.overall[0]["no_such_rate"], std::out_of_range);
}

TEST_CASE("the reference counts in the families that are its own alone, and shares of it stand there",
          "[leaderboard]") {
  const auto cell = [](std::size_t family, const HitsOf& of_method, const HitsOf& of_reference) {
    return CellScores{
        .plant = 0, .family = family, .methods = {scores_with(of_method), scores_with(of_reference)}};
  };
  const std::vector<CellScores> cells{cell(0, {{"located", {6, 10}}, {"false_alarm_healthy", {1, 9}}},
                                           {{"located", {15, 20}}, {"false_alarm_healthy", {1, 9}}}),
                                      cell(1, {{"located", {3, 10}}}, {{"located", {20, 20}}})};
  Suite suite = two_families();
  suite.families[0].has_reference = true;
  const Leaderboard board = make_leaderboard(suite, {"m", "ceiling"}, "1.0", cells);
  CHECK(has_reference(board));
  const std::vector<std::string_view> known = leaderboard_rates();
  const auto share = [&](const PooledScores& scores, std::string_view rate) {
    for (std::size_t i = 0; i < known.size(); ++i)
      if (known[i] == rate)
        return scores.shares_of_ceiling.at(i);
    return 0.0;
  };
  CHECK(share(board.by_family[0][0], "located") == Approx(0.6 / 0.75));
  CHECK(share(board.by_family[1][0], "located") == 1.0);
  CHECK(std::isnan(share(board.by_family[0][0], "source")));               // not counted
  CHECK(std::isnan(share(board.by_family[0][0], "false_alarm_healthy")));  // low is good
  CHECK(board.by_family[0][1].shares_of_ceiling.empty());
  CHECK(board.by_family[1][1].cells == 0);
  CHECK(board.by_family[1][1]["located"].total == 0);
  CHECK(board.by_plant[1][0].cells == 0);
  CHECK(board.overall[1].cells == 0);
  CHECK(board.overall[0]["located"].total == 20);
  CHECK(board.overall[0].shares_of_ceiling.empty());
  CHECK_FALSE(has_reference(make_leaderboard(suite, {"m", "n"}, "1.0", cells)));
  CHECK_FALSE(has_reference(make_leaderboard(two_families(), {"m", "ceiling"}, "1.0", cells)));
}

TEST_CASE("a cell that was not run counts nowhere, and keeps its place", "[leaderboard]") {
  const Leaderboard board =
      make_leaderboard(two_families(), {"m"}, "1.0",
                       {{.plant = 0, .family = 1, .methods = {scores_with({{"answered", {3, 4}}})}},
                        {.plant = 1, .family = 1, .trouble = "the basis case fails"}});
  CHECK(board.families.size() == 1);
  CHECK(board.by_family[0][0].cells == 1);
  CHECK(board.by_family[0][0]["answered"].total == 4);
  CHECK(board.cells[1].trouble == "the basis case fails");
  CHECK(board.by_plant[0][1].cells == 0);
  CHECK(board.by_plant[0][1]["answered"].total == 0);
}

TEST_CASE("a suite of worlds ranks its methods by source and by the gain of repairs at equal false alarms",
          "[leaderboard]") {
  const auto scores = [](std::int64_t told, std::int64_t of, double gain) {
    MethodScores made = scores_with({{"source_05_impact", {told, of}}, {"answered", {10, 10}}});
    if (gain >= 0.0)
      made.estimates[kRankingRepair] = clustered_mean(std::vector<ClusterSum>{{gain, 2}, {gain, 2}});
    return made;
  };
  std::vector<CellScores> cells{
      {.plant = 0,
       .family = 0,
       .in_worlds = true,
       .methods = {scores(3, 10, 1.0), scores(0, 0, -1.0), scores(8, 10, 0.5), scores(0, 0, 1.5)}},
      {.plant = 1,
       .family = 0,
       .in_worlds = true,
       .methods = {scores(3, 10, 0.0), scores(0, 0, -1.0), scores(8, 10, 0.5), scores(0, 0, 0.5)}}};
  const Leaderboard board =
      make_leaderboard(two_families(), {"a", "silent", "best", "channels"}, "1.0", cells);
  CHECK(board.in_worlds());
  const Estimate pooled = board.overall[0].estimates[kRankingRepair];
  CHECK(pooled.value == Approx(2.0 / 8.0));
  CHECK(pooled.count == 8);
  CHECK(board.by_plant[0][1].estimates[kRankingRepair].value == 0.0);
  const std::vector<RankedMethod> ranked = ranking(board);
  REQUIRE(ranked.size() == 4);
  CHECK((ranked[0].method == 2 && ranked[0].source == 1 && ranked[0].repair == 2));
  CHECK(
      (ranked[1].method == 0 && ranked[1].source == 2 && ranked[1].repair == 2));  // as good at repairs as it
  CHECK((ranked[2].method == 3 && !ranked[2].source && ranked[2].repair == 1));
  CHECK((ranked[3].method == 1 && !ranked[3].source && !ranked[3].repair));
  cells[1].in_worlds = false;
  CHECK(ranking(make_leaderboard(two_families(), {"a", "silent", "best", "channels"}, "1.0", cells)).empty());
}

TEST_CASE("a method that names mismatches alone has no rank among those that tell sources", "[leaderboard]") {
  const auto scores = [](std::int64_t of_mpm, std::int64_t of_ud, std::int64_t of) {
    return scores_with({{"source_05_mpm", {of_mpm, of}},
                        {"source_05_ud", {of_ud, of}},
                        {"source_05_impact", {of_mpm + of_ud, 2 * of}},
                        {"answered", {2 * of, 2 * of}}});
  };
  const auto board_of = [&](std::int64_t of) {
    return make_leaderboard(
        two_families(), {"both", "mismatches", "poor", "ceiling"}, "1.0",
        {{.plant = 0,
          .family = 0,
          .in_worlds = true,
          .methods = {scores(9, 9, of), scores(10, 0, of), scores(1, 1, of), scores(10, 10, of)}}});
  };
  const Leaderboard board = board_of(10);
  CHECK(question_rank(board, 0, kRankingSource) == 1);
  CHECK_FALSE(question_rank(board, 1, kRankingSource));
  CHECK(question_rank(board, 2, kRankingSource) == 2);  // not behind the one that does not answer
  CHECK(question_rank(board, 1, "source_05_mpm") == 1);
  CHECK(question_rank(board, 0, "source_05_mpm") == 2);
  CHECK_FALSE(question_rank(board, 0, "channel_05_impact"));
  CHECK_FALSE(question_rank(board, 3, kRankingSource));  // the reference
  const std::vector<RankedMethod> ranked = ranking(board);
  CHECK((ranked[0].method == 0 && ranked[1].method == 2 && ranked[2].method == 1));
  // Of a few loops it may be chance that it never said so.
  Leaderboard few = board_of(10);
  for (PooledScores& each : few.overall)
    each.rates["source_05_ud"] = rate(each["source_05_ud"].hits == 0 ? 0 : 1, 3);
  CHECK(question_rank(few, 1, kRankingSource) == 2);
}

TEST_CASE("a task is passed at its limits, and not below one of them", "[leaderboard]") {
  for (const LeaderboardTask task : {LeaderboardTask::detection, LeaderboardTask::location}) {
    INFO(to_string(task));
    CHECK(passes(pooled_with(kSound), task));
    CHECK_FALSE(passes(pooled_with(with(kSound, "answered", 89, 100)), task));
    CHECK_FALSE(passes(pooled_with(with(kSound, "false_alarm_healthy", 3, 20)), task));
    CHECK_FALSE(passes(pooled_with(with(kSound, "false_alarm_healthy", 0, 0)), task));
  }
  CHECK_FALSE(passes(pooled_with(with(kSound, "detected_impact", 79, 100)), LeaderboardTask::detection));
  CHECK_FALSE(passes(pooled_with(with(kSound, "located", 7, 10)), LeaderboardTask::location));
  CHECK_FALSE(passes(pooled_with(with(kSound, "located", 0, 0)), LeaderboardTask::location));
}

TEST_CASE("false alarms are marked when their whole interval lies above 5 %", "[leaderboard]") {
  // Wilson's lower limits of 3 and 4 of 20 are 0.0524 and 0.0807, that of 2 of 20 is 0.0279.
  CHECK_FALSE(pooled_with({{"false_alarm_healthy", {2, 20}}}).too_many_false_alarms());
  CHECK(pooled_with({{"false_alarm_healthy", {3, 20}}}).too_many_false_alarms());
  CHECK_FALSE(pooled_with({}).too_many_false_alarms());
}

TEST_CASE("verdicts on a part of the loops are marked, none at all are not", "[leaderboard]") {
  CHECK(pooled_with({{"answered", {89, 100}}}).answers_in_part());
  CHECK_FALSE(pooled_with({{"answered", {90, 100}}}).answers_in_part());
  CHECK_FALSE(pooled_with({{"answered", {0, 100}}}).answers_in_part());
}

}  // namespace mpm
