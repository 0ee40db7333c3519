#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/scenarios/study_texts.hpp"

// CVs with setpoints in a study file, beside CVs in ranges.

namespace mpm {
namespace {

using testing::replaced;

/// The small study with its first CV at a setpoint and without targets.
std::string mixed_study() {
  std::string text = replaced(testing::small_study(), "slack_weight = 8\nsoft = [0, 1]\n",
                              "setpoint_weight = 5\nsetpoint = 0.25\n");
  text = replaced(text, "cost = -1\nmove_suppression = 2\ntarget_weight = 3\n", "move_suppression = 2\n");
  text = replaced(text, "target_weight = 0\n", "");
  return replaced(text, "md = \"drain\"\nsample = 30", "cv = \"level\"\nsample = 30");
}

}  // namespace

TEST_CASE("a study file mixes setpoints and ranges", "[study_file]") {
  const Study study = parse_study(mixed_study(), "s.toml");
  CHECK(study.controller.setpoint_weight == Eigen::Vector2d(5, 0));
  CHECK(study.controller.has_setpoint(0));
  CHECK_FALSE(study.controller.has_setpoint(1));
  CHECK_FALSE(study.controller.has_soft_limit(0));
  CHECK(study.controller.has_soft_limit(1));
  CHECK_FALSE(study.controller.has_targets());
  CHECK(study.controller.mv_cost == Eigen::Vector2d(0, 6));

  REQUIRE(study.simulation.steps.size() == 1);
  REQUIRE(study.simulation.setpoint_steps.size() == 1);
  CHECK(study.simulation.initial_setpoint == Eigen::Vector2d(0.25, 0));
  const Eigen::MatrixXd y_set = setpoints(study);
  REQUIRE(y_set.rows() == 2);
  CHECK((y_set.row(0).head(30).array() == 0.25).all());
  CHECK((y_set.row(0).tail(30).array() == -0.25).all());
  CHECK(y_set.row(1).isZero(0));
  CHECK(setpoints(parse_study(testing::small_study(), "s.toml")).size() == 0);
}

TEST_CASE("what is wrong with setpoints is refused by name and place", "[study_file]") {
  const auto refused = [](const std::string& from, const std::string& to) {
    return testing::refusal(replaced(mixed_study(), from, to));
  };
  CHECK_THAT(refused("setpoint_weight = 5", "setpoint_weight = 0"),
             Catch::Contains("controller.cv.level.setpoint_weight: found 0; allowed: a number > 0"));
  CHECK_THAT(refused("setpoint_weight = 5\n", "slack_weight = 8\nsoft = [0, 1]\n"),
             Catch::Contains("controller.cv.level.setpoint: found a setpoint without setpoint_weight"));
  CHECK_THAT(refused("setpoint_weight = 5\n", ""),
             Catch::Contains("controller.cv.level.setpoint: found a setpoint without setpoint_weight"));
  CHECK_THAT(
      testing::refusal(replaced(testing::small_study(), "slack_weight = 9\nsoft = [-inf, 0.5]\n", "")),
      Catch::Contains("controller.cv.heat: found neither a setpoint nor a range; allowed: setpoint_weight "
                      "for a setpoint, slack_weight and soft for a range, or all three"));
  CHECK_THAT(testing::refusal(replaced(testing::small_study(), "md = \"drain\"\nsample = 10",
                                       "cv = \"heat\"\nsample = 10")),
             Catch::Contains("found a step of a setpoint, and no CV has one; allowed: none, or a CV with "
                             "controller.cv.NAME.setpoint_weight"));
  CHECK_THAT(refused("setpoint_weight = 5\n", "setpoint_weight = 5\nsoft = [0, 1]\n"),
             Catch::Contains("controller.cv.level.slack_weight: found nothing"));
  CHECK_THAT(refused("cv = \"level\"\nsample = 30", "cv = \"heat\"\nsample = 30"),
             Catch::Contains("simulation.step[0].cv: found 'heat'; allowed: level"));
  CHECK_THAT(refused("cv = \"level\"\nsample = 30", "cv = \"level\"\nmd = \"drain\"\nsample = 30"),
             Catch::Contains("simulation.step[0]: found both md and cv; allowed: exactly one of the two"));
  CHECK_THAT(refused("cv = \"level\"\nsample = 30", "sample = 30"),
             Catch::Contains("simulation.step[0]: found neither md nor cv"));
}

}  // namespace mpm
