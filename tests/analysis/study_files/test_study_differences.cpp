#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_differences.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using testing::replaced;

/// "key: before -> now"
std::vector<std::string> lines(const Study& before, const Study& now) {
  std::vector<std::string> texts;
  for (const StudyDifference& each : study_differences(before, now))
    texts.push_back(each.key + ": " + each.before + " -> " + each.now);
  return texts;
}

TEST_CASE("study differences: a study does not differ from itself, nor from its text with other blanks") {
  for (const char* name : {"chapter6", "chapter5-tank", "false-alarms"}) {
    const Study study = find_study(name);
    CHECK(lines(study, study).empty());
    CHECK(lines(study, parse_study(study.source + "\n# a comment\n", study.name)).empty());
  }
}

TEST_CASE("study differences: a default that is written out is no difference, another value is one") {
  const Study study = find_study("chapter6");
  const Study other =
      parse_study(replaced(study.source, "windows = [0.5, 2.0]", "windows = [0.5, 1.75]"), "chapter6");
  CHECK(lines(study, other) == std::vector<std::string>{"diagnosis.windows: [0.5, 2.0] -> [0.5, 1.75]"});
  CHECK(lines(other, study) == std::vector<std::string>{"diagnosis.windows: [0.5, 1.75] -> [0.5, 2.0]"});
}

TEST_CASE("study differences: a table and an entry of a list that one study has alone") {
  const Study study = find_study("chapter6");
  const Study more = parse_study(study.source + "\n[calibration]\nhealthy = 30\nud = 20\n", "chapter6");
  const std::vector<std::string> there = lines(study, more), back = lines(more, study);
  CHECK(there.size() == back.size());
  CHECK(std::find(there.begin(), there.end(), "calibration.healthy:  -> 30") != there.end());
  CHECK(std::find(back.begin(), back.end(), "calibration.healthy: 30 -> ") != back.end());

  const Study moved = parse_study(replaced(study.source, "level = 0.4\n", "level = 0.35\n"), "chapter6");
  const std::vector<std::string> steps = lines(study, moved);
  REQUIRE(steps.size() == 1);
  CHECK_THAT(steps[0], Catch::StartsWith("simulation.step[") && Catch::EndsWith("].level: 0.4 -> 0.35"));
}

TEST_CASE("study differences: seeds of a run and methods count, and seeds above those of a study file") {
  const Study study = find_study("chapter6");
  Study other = study;
  other.seed = 12345678901234567890ULL;
  other.methods = {"botelho", "sse"};
  const std::vector<std::string> found = lines(study, other);
  REQUIRE(found.size() == 2);
  CHECK_THAT(found[0], Catch::StartsWith("seed: ") || Catch::StartsWith("study.seed: "));
  CHECK_THAT(found[0], Catch::Contains(" -> 12345678901234567890"));
  CHECK_THAT(found[1], Catch::Contains("[\"botelho\"] -> [\"botelho\", \"sse\"]"));
}

}  // namespace
}  // namespace mpm
