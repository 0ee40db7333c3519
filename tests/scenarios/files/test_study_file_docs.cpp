#include <string>

#include <catch2/catch.hpp>

#include "scenarios/files/key_meaning.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "tests/scenarios/documented_keys.hpp"

namespace mpm {
namespace {

TEST_CASE("the documents of the study file have exactly the keys that the reader knows", "[study_file]") {
  testing::check_documented_keys(std::string(study_file_pages()), study_file_tables());
}

TEST_CASE("the program knows of each key what the document says of it", "[study_file]") {
  for (const StudyFileTable& table : study_file_tables())
    for (const std::string& key : table.keys) {
      INFO(table.name << " " << key);
      const KeyMeaning meaning = key_meaning(table.name, key);
      CHECK(!(meaning.meaning + meaning.allowed + meaning.fallback).empty());
    }
  const KeyMeaning interval = key_meaning("simulation.random_steps", "interval");
  CHECK(interval.unit == "samples");
  CHECK(interval.fallback == "{uniform = [60, 100]}");
  CHECK(interval.allowed == "draws >= 1");
  CHECK(interval.meaning == "from one step of an MD to its next");
  CHECK(key_meaning("plant.channel[]", "cv").fallback == "required");
  CHECK(key_meaning("simulation", "no_such_key").meaning.empty());
}

TEST_CASE("a key is explained where it comes first", "[study_file]") {
  CHECK(commented_study("[controller]\nsample_time = 1.0\n\n[controller.mv.u1]\nmove_suppression = 1.0\n\n"
                        "[controller.mv.u2]\nmove_suppression = 2.0\n") ==
        "# the range MPC (6.20) and the target optimizer (6.19)\n[controller]\n# Ts [time]; allowed: > 0\n"
        "sample_time = 1.0\n\n[controller.mv.u1]\n# Q_du of (6.20) [1 / MV^2]; allowed: >= 0\n"
        "move_suppression = 1.0\n\n[controller.mv.u2]\nmove_suppression = 2.0\n");
}

}  // namespace
}  // namespace mpm
