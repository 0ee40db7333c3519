#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "results/suite/board_file.hpp"
#include "results/suite/board_letters.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
using FileJson = nlohmann::ordered_json;

const Suite& quick() {
  static const Suite suite = find_suite("quick");
  return suite;
}

/// The shipped board with a change.
FinishedBoard read_changed(const std::function<void(FileJson&)>& change) {
  FileJson json = FileJson::parse(file_content(finished_board_path(quick())));
  change(json);
  const TemporaryFolder folder;
  make_file(folder / "q.board.json", json.dump());
  return read_board(folder / "q.board.json", quick());
}

/// The name of the first method of a board becomes another one.
void rename_first(FileJson& json, const std::string& name) {
  const std::string old = json["methods"][0]["name"];
  json["methods"][0]["name"] = name;
  for (FileJson& cell : json["cells"]) {
    FileJson methods = FileJson::object();
    for (const auto& item : cell["methods"].items())
      methods[item.key() == old ? name : item.key()] = item.value();
    cell["methods"] = methods;
  }
}

TEST_CASE("board file: the shipped board is read, and failures of methods are kept", "[suite]") {
  const FinishedBoard board = read_changed([](FileJson& json) {
    auto& of_method = json["cells"][0]["methods"]["sse"];
    for (const auto& item : of_method.items())
      if (item.key().starts_with("outcomes")) {
        std::string outcomes = item.value();
        outcomes[1] = 'A';
        item.value() = outcomes;
      }
    of_method["failed"] = 1;
  });
  CHECK(board.cells.size() == quick().cells.size());
  const auto sse = std::find(board.methods.begin(), board.methods.end(), "sse") - board.methods.begin();
  CHECK(board.cells[0].methods[static_cast<std::size_t>(sse)].failed == 1);
  CHECK(board.cells[1].methods[static_cast<std::size_t>(sse)].failed == 0);
  const Leaderboard shown = leaderboard_of(quick(), board);
  CHECK_THAT(board_text(quick(), shown, "r"), Contains("\"failed\":1"));
}

TEST_CASE("board file: stated probabilities and told sources are kept, and older files are read without them",
          "[suite]") {
  const FinishedBoard old = read_changed([](FileJson& json) {
    json.erase("outcome_texts");
    for (FileJson& cell : json["cells"])
      for (FileJson& of_method : cell["methods"]) {
        for (std::size_t text = 2; text <= outcome_text_count(); ++text)
          of_method.erase("outcomes_" + std::to_string(text));
        for (const char* const stated : {"log_score", "brier_score", "reliability"})
          of_method.erase(stated);
      }
  });
  const Leaderboard shown = leaderboard_of(quick(), old);
  const FileJson kept = FileJson::parse(board_text(quick(), shown, "r"));
  CHECK(kept["outcome_texts"] == 1);  // of what was read no more is known
  CHECK(shown.overall[0].confusions.total() == 0);
  CHECK(shown.overall[0].reliability.count() == 0);

  // A method that names a valve in each loop, as it stands in a file of today, and its probabilities.
  const auto change = [](FileJson& json) {
    json["outcome_texts"] = outcome_text_count();
    json["methods"] = {{{"name", "mine"}, {"cv", true}, {"source", true}}};
    for (FileJson& cell : json["cells"]) {
      const std::string truths = cell["truths"];
      std::string facts(truths.size(), '-'), second = facts, told = facts, none = facts;
      std::int64_t loops = 0, of_world = 0;
      FileJson sums = FileJson::array({{0.0, 0}});
      for (std::size_t i = 0; i < truths.size(); ++i)
        if (truths[i] != '-') {
          const bool is_other = fault_truth(truths[i])->kind == ExperimentKind::other;
          const LoopOutcome said{.answered = true,
                                 .flagged = true,
                                 .right_source = is_other,
                                 .names_source = true,
                                 .told = ToldSource::valve};
          const std::vector<std::string> letters = outcome_letters({said});
          facts[i] = letters[0][0];
          second[i] = letters[1][0];
          told[i] = letters.back()[0];
          none[i] = 'A';
          ++loops;
          const auto world = static_cast<std::size_t>(cell["worlds"][i].get<int>() + 1);
          while (sums.size() <= world)
            sums.push_back({0.0, 0});
          sums[world] = {0.5 * (sums[world][1].get<double>() + 1.0), sums[world][1].get<int>() + 1};
          ++of_world;
        }
      FileJson of_method{{"outcomes", facts}, {"outcomes_2", second}, {"outcomes_6", told}};
      of_method["log_score"] = of_method["brier_score"] = sums;
      for (int bin = 0; bin < 10; ++bin)
        of_method["reliability"].push_back({bin == 7 ? 0.75 * static_cast<double>(loops) : 0.0,
                                            bin == 7 ? loops : 0, bin == 7 ? loops / 2 : 0});
      cell["methods"] = {{"mine", of_method}};
    }
  };
  const Leaderboard board = leaderboard_of(quick(), read_changed(change));
  const PooledScores& mine = board.overall[0];
  CHECK(mine.confusions.total() == mine["answered"].total);
  CHECK(mine.confusions.of(AnsweredSource::valve) == mine["answered"].total);
  CHECK(mine.reliability.count() == mine["answered"].total);
  CHECK(mine.estimates["log_score"].value == Approx(0.5));
  CHECK(mine.estimates["calibration_error"].value == Approx(0.25).margin(0.02));
  const FileJson again = FileJson::parse(board_text(quick(), board, "r"));
  FileJson given = again;
  change(given);
  CHECK(again["cells"][0]["methods"]["mine"]["reliability"] ==
        given["cells"][0]["methods"]["mine"]["reliability"]);
  CHECK(again["cells"][0]["methods"]["mine"]["outcomes_6"] ==
        given["cells"][0]["methods"]["mine"]["outcomes_6"]);

  const auto refused = [&](auto damage) {
    return [&change, damage](FileJson& json) {
      change(json);
      damage(json["cells"][0]["methods"]["mine"]);
    };
  };
  const std::vector<std::pair<std::function<void(FileJson&)>, std::string>> damages{
      {[](FileJson& of) { of["reliability"].erase(0); }, "mine: reliability: found a list of 9"},
      {[](FileJson& of) { of["reliability"][7][2] = 99; }, "mine: reliability[7][2]: found 99"},
      {[](FileJson& of) { of["reliability"][7][0] = 1.0; }, "mine: reliability[7][0]: found 1"},
      {[](FileJson& of) {
         of["reliability"][7] = {0.0, 0, 0};
       },
       "mine: reliability: found"},
      {[](FileJson& of) {
         of["log_score"][1] = {9.0, 9};
       },
       "mine: log_score[1][1]: found 9"},
      {[](FileJson& of) { of.erase("log_score"); }, "mine: reliability"},
      // A source of a loop that the facts call right or none otherwise.
      {[](FileJson& of) { of["outcomes_6"] = std::string(24, 'B'); }, "mine: outcomes, loop "}};
  for (const auto& [damage, said] : damages) {
    CAPTURE(said);
    CHECK_THROWS_WITH(read_changed(refused(damage)), Contains(said));
  }
}

TEST_CASE("board file: names follow the rule of method files", "[suite]") {
  for (const char* const name :
       {"", "-x", "botelho,sun",
        "gr\xC3\xB6\xC3\x9F"
        "e",
        "all", "loops", "=cmd|x!A0", "@SUM(1)", "+1+2", "<script>alert(1)</script>", "a b", "a.b", "a/b"}) {
    CAPTURE(name);
    CHECK_THROWS_WITH(read_changed([name](FileJson& json) { rename_first(json, name); }),
                      Contains("methods[0]: name: found ") && Contains("a name of 1 to 64 letters"));
  }
  CHECK_NOTHROW(read_changed([](FileJson& json) { rename_first(json, "x-1_B"); }));
}

TEST_CASE("board file: what the suite cannot have given is refused, by its key", "[suite]") {
  using Change = std::function<void(FileJson&)>;
  const auto in_cell = [](auto change) -> Change {
    return [change](FileJson& json) { change(json["cells"][0]); };
  };
  const auto in_sse = [](auto change) -> Change {
    return [change](FileJson& json) { change(json["cells"][0]["methods"]["sse"]); };
  };
  // In the cell 0 loop 0 has a mismatch on one CV, and loop 2 is healthy.
  const std::vector<std::pair<Change, std::string>> changes{
      {in_cell([](FileJson& cell) { cell["experiments"] = 1'000'000'000'000; }),
       "cells[0]: experiments: found "},
      {in_cell([](FileJson& cell) { cell["experiments"] = 23; }), "cells[0]: truths: found "},
      {in_cell([](FileJson& cell) { cell["experiments"] = 24.5; }), "cells[0]: experiments: found 24.5"},
      {in_cell([](FileJson& cell) { cell["failed"] = -1; }), "cells[0]: failed: found -1"},
      {in_cell([](FileJson& cell) { cell["infeasible"] = 20; }), "cells[0]: failed: found 0"},
      {in_cell([](FileJson& cell) { cell["plant"] = "nowhere"; }), "cells[0]: plant: found \"nowhere\""},
      {in_cell([](FileJson& cell) { cell["family"] = 3; }), "cells[0]: family: found 3; allowed: a text"},
      {in_cell([](FileJson& cell) { cell["worlds"].erase(0); }), "cells[0]: worlds: found a list of 23"},
      {in_cell([](FileJson& cell) { cell["worlds"][3] = 7; }),
       "cells[0]: worlds[3]: found 7; allowed: 1, the world"},
      {in_cell([](FileJson& cell) { cell["truths"] = "AAAAAAAAAAAAAAAAAAAAAAAA"; }),
       "cells[0]: truths, loop 0: found 'A'"},
      {in_cell([](FileJson& cell) { cell["truths"] = 3; }), "cells[0]: truths: found 3"},
      {in_cell([](FileJson& cell) { cell["methods"] = FileJson::array(); }),
       "cells[0]: methods: found a list of 0"},
      {in_cell([](FileJson& cell) { cell["trouble"] = "none"; }),
       "cells[0]: experiments: found 24; allowed: a whole number from 0 to 0"},
      {in_sse([](FileJson& of) { of["outcomes"] = "B"; }), "methods: sse: outcomes: found "},
      {in_sse([](FileJson& of) { of["outcomes"] = "!fffffffffffffffffffffff"; }),
       "sse: outcomes, loop 0: found '!'"},
      // The source of a healthy loop, and of a method that names none.
      {in_sse([](FileJson& of) { of["outcomes"] = std::string(24, 'j'); }),
       "sse: outcomes, loop 0: found 'j'"},
      {in_sse([](FileJson& of) { of["failed"] = 25; }), "sse: failed: found 25"},
      {in_sse([](FileJson& of) { of["at_05"] = "yes"; }),
       "sse: at_05: found \"yes\"; allowed: true or false"},
      {in_sse([](FileJson& of) {
         of["detection_delay"] = {1, 1, 1, 1};
       }),
       "sse: detection_delay: found a list of 4"},
      {in_sse([](FileJson& of) {
         of["repair_gain_share"] = FileJson::array({{5.0, 1}});
       }),
       "repair_gain_share[0]"},
      {in_sse([](FileJson& of) {
         of["repair_gain_share"] = FileJson::array({{1.0, 0}, {1.0, 100}});
       }),
       "repair_gain_share[0][0]"},
      {in_sse([](FileJson& of) {
         of["repair_gain_share"] = FileJson::array({{0.0, 0}, {"Infinity", 0}});
       }),
       "repair_gain_share[1][0]"},
      {in_sse([](FileJson& of) {
         of["repair_gain_share"] = std::vector<std::vector<double>>(99, {0.0, 0.0});
       }),
       "repair_gain_share"},
      {[](FileJson& json) { json["cells"].push_back(json["cells"][0]); }, "cells[15]: family: found "},
      {[](FileJson& json) { json["cells"] = 3; }, "cells: found 3; allowed: a list"},
      {[](FileJson& json) { json["seed"] = "x"; }, "seed: found \"x\""},
      {[](FileJson& json) { json["methods"] = FileJson::array(); }, "methods: found a list of 0"},
      {[](FileJson& json) { json = FileJson::array(); }, "found a list of 0; allowed: an object"},
  };
  for (const std::pair<Change, std::string>& each : changes) {
    CAPTURE(each.second);
    CHECK_THROWS_WITH(read_changed(each.first), Contains("q.board.json: ") && Contains(each.second) &&
                                                    Contains("; allowed: ") && !Contains("[json.exception"));
    CHECK_THROWS_AS(read_changed(each.first), InputError);
  }
}

}  // namespace
