#include <catch2/catch.hpp>

#include "tests/scenarios/study_texts.hpp"

// Values of the right place but with no meaning: every one is refused with its line and key.

namespace mpm {
namespace {

using namespace testing;

const std::string kNameRule = "1 to 64 letters, digits, '_' and '-'";
const std::string kLimitRule = "[low, high] with low <= high; -inf and inf for no limit";

TEST_CASE("the heading is checked", "[study_file]") {
  check_refusals({
      {"\"small\"", "\"a name\"", "\"a name\"", "study.name: found 'a name'; allowed: " + kNameRule},
      {"\"small\"", "\"../small\"", "\"../small\"", "study.name: found '../small'; allowed: " + kNameRule},
      {"\"small\"", "5", "name = 5", "study.name: found 5; allowed: " + kNameRule},
      {"\"A small study\"", "\"\"", "title", "study.title: found ''; allowed: a text that is not empty"},
      {"\"A small study\"", "2001-01-01", "title",
       "study.title: found a date or time; allowed: a text that is not empty"},
      {"seed = 7", "seed = -7", "seed",
       "study.seed: found -7; allowed: a whole number from 0 to 9223372036854775807"},
      {"seed = 7", "seed = 7.0", "seed",
       "study.seed: found 7.0; allowed: a whole number from 0 to 9223372036854775807"},
  });
}

TEST_CASE("the variables of a plant are checked", "[study_file]") {
  check_refusals({
      {"[plant]\n", "[plant]\ncatalogue = \"shell-7x3\"\n", "name = \"mixer\"",
       "plant.name: found a key beside catalogue; allowed: catalogue alone, or an own plant without it"},
      {"name = \"heat\"", "name = \"level\"", "name = \"level\"\nunit = \"K\"",
       "plant.cv[1].name: found 'level' for a second variable; allowed: every name once"},
      {"name = \"drain\"", "name = \"hot\"", "name = \"hot\"\nunit = \"l/s\"\n\n[[plant.channel",
       "plant.md[0].name: found 'hot' for a second variable; allowed: every name once"},
      {"name = \"cold\"", "name = \"cold water\"", "name = \"cold water\"",
       "plant.mv[1].name: found 'cold water'; allowed: " + kNameRule},
      {"unit = \"K\"", "unit = 1", "unit = 1",
       "plant.cv[1].unit: found 1; allowed: a text that is not empty"},
  });
}

TEST_CASE("an unknown plant of the catalogue is refused with the known ones", "[study_file]") {
  CHECK(refusal("[study]\nname = 's'\ntitle = 's'\nseed = 1\n[plant]\ncatalogue = 'shell-7x4'\n") ==
        "s.toml:6: plant.catalogue: found 'shell-7x4' (nearest: 'shell-7x3'); allowed: shell-7x3, shell-3x3, "
        "quadruple-tank, quadruple-tank-table-3.1, quadruple-tank-flows, "
        "quadruple-tank-flows-table-3.1, distillation-column, siso, ogunnaike-ray, evaporator, "
        "column-levels, banded-20x8, "
        "coker-12x7");
}

TEST_CASE("the channels of a plant are checked", "[study_file]") {
  const std::string two_ways =
      "either gain and time_constant, or rate_gain, or numerator and denominator, or step and step_interval";
  check_refusals({
      {"cv = \"heat\"", "cv = \"heart\"", "cv = \"heart\"",
       "plant.channel[1].cv: found 'heart' (nearest: 'heat'); allowed: level, heat"},
      {"input = \"cold\"", "input = \"heat\"", "input = \"heat\"",
       "plant.channel[1].input: found 'heat' (nearest: 'hot'); allowed: hot, cold, drain"},
      {"dead_time = 2", "step_interval = 2", "numerator = [-1.5]",
       "plant.channel[1].numerator: found a second way to write a channel; allowed: step and step_interval "
       "alone"},
      {"numerator = [-1.5]\ndenominator = [20.0, 12.0, 1.0]\ndead_time = 2",
       "step = [1, 2, 3, 4, 5, 6, 7]\nstep_interval = 2",
       "step = ", "plant.channel[1].step: step response: found 7 samples; allowed: at least 8"},
      {"numerator = [-1.5]\ndenominator = [20.0, 12.0, 1.0]\ndead_time = 2",
       "step = [1, 2, 3, 4, 4, 4, 4, 4]\nstep_interval = 2000", "sample_time",
       "controller.sample_time: found 1 (coefficients of a step response reach over 1.6e+04 "
       "samples); allowed: coefficients of at most 10000 samples"},
      {"input = \"drain\"", "input = \"hot\"",
       "[[plant.channel]]\ncv = \"level\"\ninput = \"hot\"\ngain = -1",
       "plant.channel[2]: found a second channel from this input to this CV; allowed: every channel once"},
      {"time_constant = 10", "time_constant = -10", "time_constant = -10",
       "plant.channel[0].time_constant: found -10; allowed: a number > 0"},
      {"gain = 2", "gain = inf", "gain = inf", "plant.channel[0].gain: found inf; allowed: a finite number"},
      {"dead_time = 3", "dead_time = -1", "dead_time = -1",
       "plant.channel[0].dead_time: found -1; allowed: a number >= 0"},
      {"gain = 2", "gain = 2\nnumerator = [1]", "[[plant.channel]]",
       "plant.channel[0]: found both ways to write a channel; allowed: " + two_ways},
      {"gain = 2\ntime_constant = 10\n", "", "[[plant.channel]]",
       "plant.channel[0]: found no transfer function; allowed: " + two_ways},
      {"numerator = [-1.5]\n", "", "[[plant.channel]]\ncv = \"heat\"",
       "plant.channel[1].numerator: found nothing; allowed: a list of 1 to 20, each a finite number"},
      {"[-1.5]", "[nan]", "numerator",
       "plant.channel[1].numerator: found nan in the list; allowed: a list of 1 to 20, each a finite number"},
      {"[-1.5]", "['1']", "numerator",
       "plant.channel[1].numerator: found the text '1' (a number has no quotes) in the list; allowed: a list "
       "of "
       "1 to 20, each a finite number"},
      {"[-1.5]", "[1, 0, 0, 0]", "[[plant.channel]]\ncv = \"heat\"",
       "plant.channel[1]: numerator degree of a transfer function: found 3; allowed: at most the denominator "
       "degree 2"},
      {"[20.0, 12.0, 1.0]", "[20, 0, 0]", "denominator",
       "plant.channel[1].denominator: found a second pole at 0; allowed: poles with negative real parts; one "
       "pole may be 0"},
      {"numerator = [-1.5]\ndenominator = [20.0, 12.0, 1.0]", "gain = 1\nrate_gain = 1", "gain = 1",
       "plant.channel[1].gain: found a static gain beside rate_gain; allowed: one of them"},
      {"[20.0, 12.0, 1.0]", "[2, 1, -1]", "denominator",
       "plant.channel[1].denominator: found a pole with real part 0.5; allowed: poles with negative real "
       "parts; one pole may be 0"},
      {"[20.0, 12.0, 1.0]", "[1e-300, 1e300, 1]", "denominator",
       "plant.channel[1].denominator: found coefficients whose ratios overflow; allowed: coefficients of "
       "similar size"},
  });
}

TEST_CASE("slow multiple poles are stable ones", "[study_file]") {
  // (1000 s + 1)^5, whose roots -0.001 the unscaled companion matrix gives to 0.0006 only.
  CHECK(refusal(replaced(small_study(), "[20.0, 12.0, 1.0]", "[1e15, 5e12, 1e10, 1e7, 5000, 1]")) ==
        "accepted");
}

TEST_CASE("a plant in which no MV acts is refused", "[study_file]") {
  std::string text = small_study();
  text = replaced(text, "input = \"hot\"\ngain = 2", "input = \"hot\"\ngain = 0");
  text = replaced(text, "[-1.5]", "[0]");
  CHECK(refusal(text) ==
        "s.toml:" + std::to_string(line_of(text, "[[plant.channel]]")) +
            ": plant.channel: found no channel from an MV that is not zero; allowed: at least "
            "one");
}

TEST_CASE("the numbers of the controller are checked", "[study_file]") {
  check_refusals({
      {"sample_time = 1", "sample_time = 0", "sample_time",
       "controller.sample_time: found 0; allowed: a number > 0"},
      {"sample_time = 1", "sample_time = '1'", "sample_time",
       "controller.sample_time: found the text '1' (a number has no quotes); allowed: a number > 0"},
      {"sample_time = 1", "sample_time = 1e-4", "sample_time",
       "controller.sample_time: found 0.0001 (a dead time has 3e+04 samples); allowed: dead times of at most "
       "10000 samples"},
      {"prediction_horizon = 20", "prediction_horizon = 0", "prediction_horizon",
       "controller.prediction_horizon: found 0; allowed: a whole number from 1 to 2000"},
      {"prediction_horizon = 20", "prediction_horizon = 20.0", "prediction_horizon",
       "controller.prediction_horizon: found 20.0; allowed: a whole number from 1 to 2000"},
      {"control_horizon = 5", "control_horizon = 21", "control_horizon",
       "controller.control_horizon: found 21; allowed: a whole number from 1 to 20"},
      {"control_horizon = 5", "control_horizon = 5\nslack = 'per-mv'",
       "slack = ", "controller.slack: found 'per-mv' (nearest: 'per-cv'); allowed: per-sample, per-cv"},
      {"control_horizon = 5", "control_horizon = 5\nweight_convention = true", "weight_convention",
       "controller.weight_convention: found true; allowed: direct, squared"},
      {"control_horizon = 5", "control_horizon = 5\ntarget_violation_cost = 0", "target_violation_cost",
       "controller.target_violation_cost: found 0; allowed: a number > 0"},
      {"control_horizon = 5", "control_horizon = 5\nsolver_time_limit = 0", "solver_time_limit",
       "controller.solver_time_limit: found 0; allowed: a number > 0"},
      {"cost = -1", "cost = nan", "cost = nan",
       "controller.mv.hot.cost: found nan; allowed: a finite number"},
      {"move_suppression = 2", "move_suppression = -2", "move_suppression = -2",
       "controller.mv.hot.move_suppression: found -2; allowed: a number >= 0"},
      {"target_weight = 3", "target_weight = inf", "target_weight = inf",
       "controller.mv.hot.target_weight: found inf; allowed: a number >= 0"},
      {"move_suppression = 7", "move_suppression = 0", "[controller]",
       "controller: move_suppression[1] and target_weight[1]: found both 0; allowed: at least one > 0: "
       "without setpoints the moves would not be determined"},
      {"slack_weight = 8", "slack_weight = 0", "slack_weight = 0",
       "controller.cv.level.slack_weight: found 0; allowed: a number > 0"},
  });
}

TEST_CASE("the limits of the controller are checked", "[study_file]") {
  check_refusals({
      {"[-4, 5]", "[5, -4]", "hard = [5", "controller.mv.hot.hard: found [5, -4]; allowed: " + kLimitRule},
      {"[-4, 5]", "[nan, 5]", "hard = [nan",
       "controller.mv.hot.hard: found [nan, 5]; allowed: " + kLimitRule},
      {"[-4, 5]", "[inf, inf]", "hard = [inf",
       "controller.mv.hot.hard: found [inf, inf]; allowed: " + kLimitRule},
      {"[-4, 5]", "[-4, 0, 5]", "hard = [-4, 0",
       "controller.mv.hot.hard: found a list of 3; allowed: " + kLimitRule},
      {"[-4, 5]", "5", "hard = 5", "controller.mv.hot.hard: found 5; allowed: " + kLimitRule},
      {"[-4, 5]", "['a', 5]", "hard = ['a'",
       "controller.mv.hot.hard: found the text 'a' in the list; allowed: " + kLimitRule},
      {"[0, 1]", "[0, 2.5]", "soft = [0, 2.5]",
       "controller.cv.level.soft: found [0, 2.5]; allowed: limits within the hard ones [-2, 2]"},
      {"[0, 1]", "[-3, 1]", "soft = [-3, 1]",
       "controller.cv.level.soft: found [-3, 1]; allowed: limits within the hard ones [-2, 2]"},
  });
}

}  // namespace
}  // namespace mpm
