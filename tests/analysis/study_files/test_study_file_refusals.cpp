#include <catch2/catch.hpp>

#include "scenarios/toml/toml_text.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

TEST_CASE("the unchanged small study is accepted", "[study_file]") {
  CHECK(refusal(small_study()) == "accepted");
}

TEST_CASE("the message of the document is the one that the reader gives", "[study_file]") {
  const std::string text = replaced(project_file("scenarios/studies/chapter6.toml"), "control_horizon = 15",
                                    "control_horizon = 80");
  const std::string message =
      "19: controller.control_horizon: found 80; allowed: a whole number from 1 to 75";
  CHECK(refusal(text) == "s.toml:" + message);
  CHECK(project_file("docs/study_file.md").find("chapter6.toml:" + message) != std::string::npos);
}

TEST_CASE("a text that is no TOML is refused with the parser's line", "[study_file]") {
  const std::string message = refusal("[study]\nname = \n");
  CHECK(message.rfind("s.toml:2: TOML: found ", 0) == 0);
  CHECK(refusal("a = 1\na = 2\n").rfind("s.toml:2: TOML: found ", 0) == 0);  // a key twice
  CHECK(refusal("a = '\xff'\n").rfind("s.toml:1: TOML: found ", 0) == 0);    // no UTF-8
}

TEST_CASE("texts that would cost too much are refused", "[study_file]") {
  CHECK(refusal(std::string(kMaxTomlBytes + 1, '\n')) ==
        "s.toml:1: TOML: found 1048577 bytes; allowed: at most 1048576");
  CHECK(refusal(std::string(kMaxTomlBytes, '\n')) ==
        "s.toml:1: study: found nothing; allowed: a table");  // the largest one
  std::string deep = "\na";
  for (int i = 0; i < 200000; ++i) {
    deep += ".a";  // each dot is one more table in the table
  }
  CHECK(refusal(deep + " = 1") ==
        "s.toml:2: TOML: found 200000 dots in one key, or in a line with quotes; allowed: at most 64");
}

TEST_CASE("a list of many numbers is no deep key", "[study_file]") {
  std::string noise = "noise = {cv0 = 0.5";
  for (int cv = 1; cv < 200; ++cv)
    noise += ", cv" + std::to_string(cv) + " = 0.5";
  CHECK(parse_toml(noise + "}", "s.toml")["noise"].as_table()->size() == 200);
}

TEST_CASE("unknown keys and tables are refused with the nearest and all allowed ones", "[study_file]") {
  check_refusals({
      {"[experiments]", "[experiment]", "[experiment]",
       "top level: found unknown key 'experiment' (nearest: 'experiments'); allowed: study, plant, "
       "controller, "
       "simulation, record, experiments, world, scenario, mismatch, disturbance, tuning, other, onset, "
       "sensitivity, "
       "s0_perturbation, diagnosis, methods, assessment, monitoring, calibration, aggregate, data, "
       "reference"},
      {"seed = 7", "seed = 7\nsed = 8", "sed = 8",
       "study: found unknown key 'sed' (nearest: 'seed'); allowed: name, title, seed"},
      {"sample_time = 1", "sampletime = 1", "sampletime",
       "controller: found unknown key 'sampletime' (nearest: 'sample_time'); allowed: sample_time, "
       "prediction_horizon, control_horizon, move_blocks, weight_convention, slack, target_violation_cost, "
       "solver_time_limit, mv, cv, md, program"},
      {"cost = 6", "cost = 6\nzzz = 1", "zzz",
       "controller.mv.cold: found unknown key 'zzz'; allowed: cost, move_suppression, target_weight, "
       "resting_value, resting_weight, hard, move_limit"},
      {"level = -0.25", "level = -0.25\nmv = 'hot'", "mv = 'hot'",
       "simulation.step[0]: found unknown key 'mv' (nearest: 'md'); allowed: md, cv, sample, level"},
      {"dead_time = 2", "dead_tim = 2", "dead_tim = 2",
       "plant.channel[1]: found unknown key 'dead_tim' (nearest: 'dead_time'); allowed: cv, input, gain, "
       "rate_gain, time_constant, numerator, denominator, dead_time, step, step_interval"},
      {"[controller.mv.cold]", "[controller.mv.warm]", "[controller.mv.warm]",
       "controller.mv: found unknown key 'warm'; allowed: hot, cold"},
  });
}

TEST_CASE("a text in the place of a number is called a text", "[study_file]") {
  check_refusals({
      {"sample_time = 1\n", "sample_time = \"4.3\"\n", "sample_time",
       "controller.sample_time: found the text '4.3' (a number has no quotes); allowed: a number > 0"},
      {"sample_time = 1\n", "sample_time = \"1 min\"\n", "sample_time",
       "controller.sample_time: found the text '1 min'; allowed: a number > 0"},
      {"samples = 60\n", "samples = \"60\"\n", "samples = \"60\"",
       "simulation.samples: found the text '60' (a number has no quotes); allowed: a whole number from 1 to "
       "1000000"},
      {"soft = [0, 1]\n", "soft = [\"0\", 1]\n", "soft = [\"0\", 1]",
       "controller.cv.level.soft: found the text '0' (a number has no quotes) in the list; allowed: [low, "
       "high] "
       "with low <= high; -inf and inf for no limit"},
  });
}

TEST_CASE("missing tables and keys are refused at the line of their table", "[study_file]") {
  check_refusals({
      {"[study]", "[[study]]", "[[study]]", "study: found a list of 1; allowed: a table"},
      {"name = \"small\"\n", "", "[study]",
       "study.name: found nothing; allowed: 1 to 64 letters, digits, '_' and '-'"},
      {"seed = 7\n", "", "[study]",
       "study.seed: found nothing; allowed: a whole number from 0 to 9223372036854775807"},
      {"time_unit = \"s\"\n", "", "[plant]",
       "plant.time_unit: found nothing; allowed: a text that is not empty"},
      {"unit = \"K\"\n", "", "[[plant.cv]]\nname = \"heat\"",
       "plant.cv[1].unit: found nothing; allowed: a text that is not empty"},
      {"[simulation]\n", "[controller.md.rain]\nanalyser_delay = 3\n[simulation]\n", "[controller.md.rain]",
       "controller.md: found unknown key 'rain' (nearest: 'drain'); allowed: drain"},
      {"[simulation]\n", "[controller.md.drain]\nanalyser_delay = -1\n[simulation]\n", "analyser_delay",
       "controller.md.drain.analyser_delay: found -1; allowed: a whole number from 0 to 2000"},
      {"sample_time = 1\n", "", "[controller]",
       "controller.sample_time: found nothing; allowed: a number > 0"},
      {"[controller.cv.heat]\nslack_weight = 9\nsoft = [-inf, 0.5]\nhard = [-inf, 3]\n", "",
       "[controller.cv.level]", "controller.cv.heat: found nothing; allowed: a table"},
      {"cost = -1\n", "", "[controller.mv.hot]",
       "controller.mv.hot.cost: found nothing; allowed: a finite number"},
      {"soft = [0, 1]\n", "", "[controller.cv.level]",
       "controller.cv.level.soft: found nothing; allowed: [low, high] with low <= high; -inf and inf for no "
       "limit"},
      {"samples = 60\n", "", "[simulation]",
       "simulation.samples: found nothing; allowed: a whole number from 1 to 1000000"},
      {"noise_standard_deviation = 0.01\n", "", "[simulation]",
       "simulation.noise_standard_deviation: found nothing; allowed: a number >= 0, or a table with one for "
       "each CV"},
      {"sample = 10\n", "", "[[simulation.step]]\nmd = \"drain\"\nlevel = 0.5",
       "simulation.step[1].sample: found nothing; allowed: a whole number from 0 to 59"},
      {"mpm_ud = 1\n", "", "[experiments]",
       "experiments.mpm_ud: found nothing; allowed: a whole number from 0 to 10000000"},
  });
}

TEST_CASE("a missing table of the top level is refused", "[study_file]") {
  CHECK(refusal("") == "s.toml:1: study: found nothing; allowed: a table");
  std::string text = small_study();
  text.erase(text.find("[experiments]"));
  CHECK(refusal(text) == "s.toml:1: experiments: found nothing; allowed: a table");
}

}  // namespace
}  // namespace mpm
