#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

const std::string kCalibration = "\n[calibration]\n";

TEST_CASE("calibration: none without its table, and the defaults of an empty one", "[study_file]") {
  CHECK_FALSE(parse_study(small_study(), "s").calibration.has_value());
  const Study study = parse_study(small_study() + kCalibration, "s");
  REQUIRE(study.calibration.has_value());
  CHECK(*study.calibration == CalibrationOptions{});
  const Study other =
      parse_study(small_study() + kCalibration + "false_alarms = 0.1\nhealthy = 30\nud = 0\nseed = 8\n", "s");
  CHECK(*other.calibration == CalibrationOptions{0.1, 30, 0, 8});
}

TEST_CASE("calibration: what is no rate, no number of loops or the seed of the study is refused",
          "[study_file]") {
  check_refusals({
      {"", "[calibration]\nfalse_alarms = 1\n", "false_alarms",
       "calibration.false_alarms: found 1; allowed: a number in (0, 1)"},
      {"", "[calibration]\nhealthy = 0\n", "healthy = 0",
       "calibration.healthy: found 0; allowed: a whole number from 1 to 1000000"},
      {"", "[calibration]\nud = -1\n", "ud = -1",
       "calibration.ud: found -1; allowed: a whole number from 0 to 1000000"},
      {"", "[calibration]\n seed = 7\n", " seed = 7",
       "calibration.seed: found 7, the seed of the study; allowed: another one"},
      {"", "[calibration]\nloops = 7\n", "loops = 7",
       "calibration: found unknown key 'loops'; allowed: false_alarms, healthy, ud, worlds, seed"},
  });
}

TEST_CASE("calibration: a study of named scenarios has none", "[study_file]") {
  std::string text = small_study();
  text.erase(text.find("[experiments]"));
  text += "[[scenario]]\nname = 'none'\n[calibration]\n";
  CHECK(refusal(text).find("calibration: found calibration of a study of named scenarios") !=
        std::string::npos);
}

TEST_CASE("calibration: its seed is never that of the study", "[calibration]") {
  Study study = parse_study(small_study() + kCalibration, "s");
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{7}, kCalibrationBits, ~std::uint64_t{0}}) {
    study.seed = seed;
    CHECK(calibration_seed(study) == (seed ^ kCalibrationBits));
    CHECK(calibration_seed(study) != seed);
  }
  study.calibration->seed = 9;
  CHECK(calibration_seed(study) == 9);
  study.seed = 9;  // by run --seed
  CHECK_THROWS_WITH(calibration_study(study),
                    "calibration.seed: found 9, the seed of the study; allowed: another one");
}

TEST_CASE("calibration: its loops are healthy or disturbed, with other noise and the excitation of the study",
          "[calibration]") {
  std::string text =
      replaced(small_study(), "= 0.01",
               "= 0.01\nrandom_steps.interval.uniform = [3, 9]\n"
               "md_noise = {standard_deviation = 0.1}\ndither = [{mv = 'hot', amplitude = 0.1}]");
  const std::size_t begin = text.find("[[simulation.step]]");
  text.erase(begin, text.find("[experiments]") - begin);
  Study study = parse_study(text + kCalibration + "healthy = 4\nud = 2\n", "s");
  const Study loops = calibration_study(study);
  REQUIRE(loops.experiment_count() == 6);
  int healthy = 0;
  for (std::int64_t index = 0; index < 6; ++index) {
    const ExperimentDraw draw = draw_experiment(loops, index);
    healthy += draw.kind == ExperimentKind::healthy ? 1 : 0;
    CHECK((draw.kind == ExperimentKind::healthy || draw.kind == ExperimentKind::ud));
    CHECK(measurement_noise(loops, index) != measurement_noise(study, index));
  }
  CHECK(healthy == 4);
  CHECK(dither(loops) == dither(study));
  const Eigen::MatrixXd d = measured_disturbances(study);
  CHECK(measured_disturbances(loops) == d);
  CHECK((d.array() != 0.0).any());
  study.seed = loops.seed;
  CHECK(measured_disturbances(study) != d);  // a study of that seed is moved in another way
}

}  // namespace
}  // namespace mpm
