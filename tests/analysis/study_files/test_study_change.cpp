#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

Study changed(const std::vector<StudyChange>& changes) {
  return changed_study(find_study("chapter4-shell"), changes, "s");
}

std::string change_refusal(const std::vector<StudyChange>& changes) {
  try {
    changed(changes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refused_text(const std::string& text) {
  try {
    parse_study_change(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A table of one cell, with a variant that has its own noise.
ThesisTable small_table() {
  ThesisTable table;
  table.number = "4.5";
  table.studies.emplace("", find_study("chapter4-shell"));
  table.studies.emplace("loud", changed({{"simulation.noise_standard_deviation", "0.5"}}));
  table.rows = {{"1", "", "Scen1", {{"y1", "ivar", 4.54}}}};
  return table;
}

}  // namespace

TEST_CASE("a change is a key, an equals sign and a value in TOML", "[study_change]") {
  const StudyChange change = parse_study_change("simulation.step=[{cv = \"y1\", sample = 3, level = 1}]");
  CHECK(change.key == "simulation.step");
  CHECK(change.value == "[{cv = \"y1\", sample = 3, level = 1}]");
  CHECK(parse_study_change("a.b=").value.empty());
  CHECK(refused_text("controller") == "--set: found 'controller'; allowed: KEY=VALUE");
  CHECK(refused_text("=3") == "--set: found '=3'; allowed: KEY=VALUE");
  for (const char* key : {"a..b=1", ".a=1", "a.=1"}) {
    INFO(key);
    CHECK_THAT(refused_text(key), Catch::Contains("allowed: keys between single dots"));
  }
  CHECK_THAT(refused_text("a.b=squared"), Catch::Contains("--set a.b:1: TOML: found "));
  CHECK_THAT(refused_text("a=1\nb=2"), Catch::Contains("a line break in a value"));
}

TEST_CASE("a changed study has the value, and everything else as before", "[study_change]") {
  const Study base = changed({});
  const Study study = changed({{"controller.mv.u2.move_suppression", "10"}});
  CHECK(study.controller.move_suppression(1) == 10.0);
  CHECK(study.controller.move_suppression(0) == base.controller.move_suppression(0));
  CHECK(study.controller.move_suppression(0) != 10.0);
  CHECK(study.simulation.samples == base.simulation.samples);
  CHECK(study.scenarios.size() == base.scenarios.size());
}

TEST_CASE("changes are made in their order; tables are laid over, and tables that are missing begin",
          "[study_change]") {
  CHECK(changed({{"seed", "3"}, {"study.seed", "4"}, {"seed", ""}}).seed == 4);
  const Study base = changed({});
  const Study study = changed({{"controller.mv.u2", "{move_suppression = 7}"},

                               {"diagnosis.windows", "[0.25, 1.0]"}});
  CHECK(study.controller.move_suppression(1) == 7.0);
  CHECK(study.controller.mv_hard.upper(1) == base.controller.mv_hard.upper(1));  // of the same table
  CHECK(study.diagnosis.shortest_window == 0.25);
}

TEST_CASE("an entry of a list of tables goes by its name", "[study_change]") {
  const Study base = changed({});
  const std::string second = base.scenarios.at(1).name;
  const Study study =
      changed({{"scenario." + second + ".mismatch", ""},
               {"scenario." + second + ".disturbance", "[{cv = \"y3\", gain = 0.125, time_constant = 9}]"}});
  CHECK(study.scenarios.at(1).name == second);
  REQUIRE(study.scenarios[1].disturbances.size() == 1);
  CHECK(study.scenarios[1].mismatches.empty());
  CHECK(base.scenarios[1].mismatches.size() == 1);
  CHECK(study.scenarios[0].disturbances.size() == base.scenarios[0].disturbances.size());
}

TEST_CASE("a key that there is not is refused by its name", "[study_change]") {
  CHECK_THAT(
      change_refusal({{"controller.mv.u2.move_supression", "10"}}),
      Catch::Contains("controller.mv.u2: found unknown key 'move_supression' (nearest: 'move_suppression')"));
  CHECK_THAT(change_refusal({{"simulation.none", ""}}),
             Catch::Contains("s: simulation.none: found a key that the study does not have"));
  CHECK_THAT(change_refusal({{"scenario.Scen99.mismatch", "[]"}}),
             Catch::Contains("s: scenario.Scen99.mismatch: found 'Scen99'"));
  CHECK_THAT(change_refusal({{"simulation.step.first.level", "1"}}),
             Catch::Contains("found a list without names"));
  CHECK_THAT(change_refusal({{"simulation.samples.x", "1"}}), Catch::Contains("'samples', which is "));
}

TEST_CASE("the studies of a table are changed after their variants", "[study_change]") {
  ThesisTable table = small_table();
  change_studies(table, {{"simulation.samples", "800"}});
  CHECK(table.studies.at("").simulation.samples == 800);
  CHECK(table.studies.at("loud").simulation.samples == 800);
  CHECK(table.studies.at("loud").simulation.noise_standard_deviation(0) == 0.5);
  change_studies(table, {{"simulation.noise_standard_deviation", "0.25"}});
  CHECK(table.studies.at("loud").simulation.noise_standard_deviation(0) == 0.25);
}

TEST_CASE("a change that removes a scenario of the table is refused", "[study_change]") {
  ThesisTable table = small_table();
  CHECK_THROWS_WITH(change_studies(table, {{"scenario.Scen1.name", "\"other\""}}),
                    Catch::Contains("a change that removes scenario 'Scen1'"));
}

}  // namespace mpm
