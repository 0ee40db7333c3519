#include <catch2/catch.hpp>

#include "tests/scenarios/study_texts.hpp"

// Refusals in the tables that say what is simulated, drawn and concluded.

namespace mpm {
namespace {

using namespace testing;

std::string every_draw(const std::string& rule) {
  return "a distribution whose every draw is a number " + rule;
}

TEST_CASE("the simulation is checked", "[study_file]") {
  check_refusals({
      {"samples = 60", "samples = 0", "samples = 0",
       "simulation.samples: found 0; allowed: a whole number from 1 to 1000000"},
      {"samples = 60", "samples = 59", "samples = 59",
       "simulation.samples: found 59; allowed: at least 60: the longest moving window has 40 samples"},
      {"deviation = 0.01", "deviation = -0.01", "noise_",
       "simulation.noise_standard_deviation: found -0.01; allowed: a number >= 0"},
      {"deviation = 0.01", "deviation = [0.01]", "noise_",
       "simulation.noise_standard_deviation: found a list of 1; allowed: a number >= 0"},
      {"deviation = 0.01", "deviation = {level = 1}", "noise_",
       "simulation.noise_standard_deviation.heat: found nothing; allowed: a number >= 0"},
      {"deviation = 0.01", "deviation = {level = 1, heat = 1, hot = 1}", "noise_",
       "simulation.noise_standard_deviation: found unknown key 'hot'; allowed: level, "
       "heat"},
      {"sample = 30", "sample = 60", "sample = 60",
       "simulation.step[0].sample: found 60; allowed: a whole number from 0 to 59"},
      {"sample = 30", "sample = -1", "sample = -1",
       "simulation.step[0].sample: found -1; allowed: a whole number from 0 to 59"},
      {"sample = 30", "sample = 10", "sample = 10\nlevel = 0.5",
       "simulation.step[1].sample: found 10 for a second step of this variable; allowed: one step a sample"},
      {"md = \"drain\"", "md = \"hot\"", "md = \"hot\"",
       "simulation.step[0].md: found 'hot'; allowed: drain"},
      {"level = 0.5", "level = inf", "level = inf",
       "simulation.step[1].level: found inf; allowed: a finite number"},
      {"deviation = 0.01", "deviation = 0.01\nrandom_steps = {}", "[simulation]",
       "simulation: found both step of an MD and random_steps; allowed: exactly one of the two"},
  });
}

TEST_CASE("a plant with measured disturbances must be excited", "[study_file]") {
  std::string text = small_study();
  const std::size_t begin = text.find("[[simulation.step]]");
  text.erase(begin, text.find("[experiments]") - begin);
  const std::string line = std::to_string(line_of(text, "[simulation]"));
  CHECK(
      refusal(text) ==
      "s.toml:" + line +
          ": simulation: found no excitation; allowed: step, random_steps, limit_step, md_noise, dither, or "
          "excitation = \"none\"");
  CHECK(refusal(replaced(text, "= 0.01", "= 0.01\nstep = []")).find("simulation.step: found a list of 0") !=
        std::string::npos);
  CHECK(refusal(replaced(text, "= 0.01", "= 0.01\nrandom_steps.interval.uniform = [0, 9]")) ==
        "s.toml:" + std::to_string(line_of(text, "= 0.01") + 1) +
            ": simulation.random_steps.interval: found draws from 0 to 9; allowed: " + every_draw(">= 1"));
}

TEST_CASE("the numbers of experiments are checked", "[study_file]") {
  check_refusals({
      {"ud = 2", "ud = -2", "ud = -2",
       "experiments.ud: found -2; allowed: a whole number from 0 to 10000000"},
      {"mpm = 3\nud = 2\nmpm_ud = 1", "mpm = 0\nud = 0\nmpm_ud = 0", "[experiments]",
       "experiments: found no experiment; allowed: at least one of any kind"},
  });
}

TEST_CASE("distributions are checked", "[study_file]") {
  const std::string kinds =
      "one of {constant = x}, {uniform = [low, high]}, {log_uniform = [low, high]}, "
      "{normal = [mean, standard deviation]}";
  check_refusals({
      {"", "[mismatch]\ngain_factor = 2\n", "gain_factor", "mismatch.gain_factor: found 2; allowed: a table"},
      {"", "[mismatch]\ngain_factor = {}\n", "gain_factor",
       "mismatch.gain_factor: found a table with 0 keys; allowed: " + kinds},
      {"", "[mismatch]\ngain_factor = {constant = 1, uniform = [1, 2]}\n", "gain_factor",
       "mismatch.gain_factor: found a table with 2 keys; allowed: " + kinds},
      {"", "[mismatch]\ngain_factor = {unifrom = [1, 2]}\n", "gain_factor",
       "mismatch.gain_factor: found unknown key 'unifrom' (nearest: 'uniform'); allowed: constant, uniform, "
       "log_uniform, normal"},
      {"", "[mismatch]\ngain_factor = {constant = inf}\n", "gain_factor",
       "mismatch.gain_factor.constant: found inf; allowed: a finite number"},
      {"", "[mismatch]\ngain_factor = {uniform = [1, inf]}\n", "gain_factor",
       "mismatch.gain_factor.uniform: found [1, inf]; allowed: [low, high], two finite numbers"},
      {"", "[mismatch]\ngain_factor = {uniform = [1]}\n", "gain_factor",
       "mismatch.gain_factor.uniform: found a list of 1; allowed: [low, high], two finite numbers"},
      {"", "[mismatch]\ndead_time_shift = {normal = 1}\n", "dead_time_shift",
       "mismatch.dead_time_shift.normal: found 1; allowed: [mean, standard deviation], two finite numbers"},
  });
  // What Distribution itself refuses gets line and key in front.
  CHECK(refusal(small_study() + "[mismatch]\ngain_factor = {uniform = [2, 1]}\n")
            .find(": mismatch.gain_factor.uniform: ") != std::string::npos);
  CHECK(refusal(small_study() + "[mismatch]\ngain_factor = {log_uniform = [0, 1]}\n")
            .find(": mismatch.gain_factor.log_uniform: ") != std::string::npos);
  CHECK(refusal(small_study() + "[mismatch]\ndead_time_shift = {normal = [0, -1]}\n")
            .find(": mismatch.dead_time_shift.normal: ") != std::string::npos);
}

TEST_CASE("the ranges of mismatches are checked", "[study_file]") {
  check_refusals({
      {"", "[mismatch]\nparameter_weights = {gain = 1, time_constant = 1}\n", "parameter_weights",
       "mismatch.parameter_weights.dead_time: found nothing; allowed: a number >= 0"},
      {"", "[mismatch]\nparameter_weights = {gain = -1, time_constant = 1, dead_time = 1}\n",
       "parameter_weights", "mismatch.parameter_weights.gain: found -1; allowed: a number >= 0"},
      {"", "[mismatch]\nparameter_weights = {gain = 0, time_constant = 0, dead_time = 0}\n",
       "parameter_weights",
       "mismatch.parameter_weights: found weights that are all 0; allowed: at least one > 0"},
      {"", "[mismatch]\ngain_factor = {uniform = [0, 1]}\n", "gain_factor",
       "mismatch.gain_factor: found draws from 0 to 1; allowed: " + every_draw("> 0")},
      {"", "[mismatch]\ntime_constant_factor = {normal = [1, 0.1]}\n", "time_constant_factor",
       "mismatch.time_constant_factor: found draws from -inf to inf; allowed: " + every_draw("> 0")},
      {"", "[mismatch]\ndead_time_shift = {uniform = [-4, -2]}\n", "dead_time_shift",
       "mismatch.dead_time_shift: found draws of at most -2; allowed: draws that can be > -2: the shortest "
       "dead "
       "time is 2"},
      {"", "[mismatch]\ndead_time_shift = {constant = -3}\n", "dead_time_shift",
       "mismatch.dead_time_shift: found draws of at most -3; allowed: draws that can be >= -2: the shortest "
       "dead "
       "time is 2"},
  });
  CHECK(refusal(small_study() + "[mismatch]\ndead_time_shift = {constant = -2}\n") == "accepted");
}

TEST_CASE("the ranges of disturbances are checked", "[study_file]") {
  check_refusals({
      {"", "[disturbance]\ngain = {constant = 0}\n", "gain = {",
       "disturbance.gain: found draws from 0 to 0; allowed: " + every_draw("> 0")},
      {"", "[disturbance]\ntime_constant = {uniform = [-1, 2]}\n", "time_constant = {",
       "disturbance.time_constant: found draws from -1 to 2; allowed: " + every_draw("> 0")},
      {"", "[disturbance]\nv_standard_deviation = 0\n", "v_standard",
       "disturbance.v_standard_deviation: found 0; allowed: a number > 0"},
  });
}

TEST_CASE("the options of the sensitivity are checked", "[study_file]") {
  check_refusals({
      {"", "[sensitivity]\nsamples = 1\n", "samples = 1\n",
       "sensitivity.samples: found 1; allowed: a whole number from 2 to 100000"},
      {"", "[sensitivity]\nstep_size = -0.1\n", "step_size",
       "sensitivity.step_size: found -0.1; allowed: a number > 0"},
      {"", "[sensitivity]\nstep_size = 1.5\n", "step_size",
       "sensitivity.step_size: found 1.5; allowed: at most the narrowest range between soft limits, 1"},
      {"", "[sensitivity]\nactive_cvs = []\n", "active_cvs",
       "sensitivity.active_cvs: found a list of 0; allowed: a list of one or more of level, heat"},
      {"", "[sensitivity]\nactive_cvs = ['cold']\n", "active_cvs",
       "sensitivity.active_cvs: found 'cold'; allowed: level, heat"},
      {"", "[sensitivity]\nactive_cvs = [1]\n", "active_cvs",
       "sensitivity.active_cvs: found 1; allowed: level, heat"},
      {"", "[sensitivity]\nactive_cvs = ['heat', 'heat']\n", "active_cvs",
       "sensitivity.active_cvs: found 'heat' twice; allowed: every name once"},
  });
  // 'heat' has an infinite range, so a wide step is no fault of it.
  CHECK(refusal(small_study() + "[sensitivity]\nstep_size = 1.5\nactive_cvs = ['heat']\n") == "accepted");
}

TEST_CASE("active CVs need soft limits, and no more of them can be active than there are MVs",
          "[study_file]") {
  const std::string free = replaced(small_study(), "soft = [-inf, 0.5]", "soft = [-inf, inf]");
  CHECK(
      refusal(free + "[sensitivity]\nactive_cvs = ['heat']\n") ==
      "s.toml:" + std::to_string(line_of(free, "mpm_ud = 1") + 2) +
          ": sensitivity.active_cvs: found 'heat', which has no soft limit; allowed: CVs with a soft limit");
  const std::string text = replaced(project_file("scenarios/studies/chapter6.toml"),
                                    "[\"y1\", \"y2\", \"y7\"]", "[\"y1\", \"y2\", \"y7\", \"y3\"]");
  CHECK(refusal(text) == "s.toml:" + std::to_string(line_of(text, "active_cvs")) +
                             ": sensitivity.active_cvs: found 4 CVs; allowed: at most as many as MVs, 3");
}

TEST_CASE("the options of the perturbation of S0 are checked", "[study_file]") {
  check_refusals({
      {"", "[s0_perturbation]\ncvs = ['level']\n", "[s0_perturbation]",
       "s0_perturbation.multipliers: found nothing; allowed: a list of 1 to 1000, each a number > 0"},
      {"", "[s0_perturbation]\nmultipliers = [0.5, 2, 1]\n", "multipliers",
       "s0_perturbation.multipliers: found 1 after 2; allowed: numbers in ascending order"},
      {"", "[s0_perturbation]\nmultipliers = [1]\ncvs = ['cold']\n", "cvs",
       "s0_perturbation.cvs: found 'cold'; allowed: level, heat"},
      {"", "[s0_perturbation]\nmultipliers = [1]\ntolerance = [1.2, 0.8]\n", "tolerance",
       "s0_perturbation.tolerance: found [1.2, 0.8]; allowed: [low, high] with low < high, each a number > "
       "0"},
      {"", "[s0_perturbation]\nmultipliers = [1]\nfixed_active_cvs = ['heat']\n", "fixed_active_cvs",
       "s0_perturbation.fixed_active_cvs: found a list without fixed_mvs; allowed: a list beside fixed_mvs"},
      {"",
       "[s0_perturbation]\nmultipliers = [1]\nfixed_mvs = ['hot']\nfixed_active_cvs = ['heat', 'level']\n",
       "fixed_active_cvs",
       "s0_perturbation.fixed_active_cvs: found 2 CVs; allowed: at most as many as MVs that are not fixed, "
       "1"},
  });
}

TEST_CASE("the options of the diagnosis and of the aggregates are checked", "[study_file]") {
  const std::string band = "[low, high] with low < high, each a number > 0";
  check_refusals({
      {"", "[diagnosis]\nimpact_band = [1.2, 0.8]\n", "impact_band",
       "diagnosis.impact_band: found [1.2, 0.8]; allowed: " + band},
      {"", "[diagnosis]\nself_check_band = [0, 0.8]\n", "self_check_band",
       "diagnosis.self_check_band: found [0, 0.8]; allowed: " + band},
      {"", "[diagnosis]\nlocation_distance = 'log'\n", "location_distance",
       "diagnosis.location_distance: found 'log'; allowed: linear, logarithmic"},
      {"", "[diagnosis]\nmpm_threshold = 1\n", "mpm_threshold",
       "diagnosis.mpm_threshold: found 1; allowed: a number in (0, 1)"},
      {"", "[diagnosis]\nwindows = [0, 2]\n", "windows",
       "diagnosis.windows: found [0, 2]; allowed: [low, high] with low < high, each a number in (0, 1000]"},
      {"", "[diagnosis]\nwindows = [0.5, 1001]\n", "windows",
       "diagnosis.windows: found [0.5, 1001]; allowed: [low, high] with low < high, each a number in (0, "
       "1000]"},
      {"", "[diagnosis]\nwindows = [0.5, 3]\n", "samples = 60",
       "simulation.samples: found 60; allowed: at least 80: the longest moving window has 60 samples"},
      {"", "[diagnosis]\nwindows = [0.1, 2]\n", "prediction_horizon",
       "controller.prediction_horizon: found 20 (the shortest moving window has 2 samples); allowed: windows "
       "of at least 4 samples"},
      {"", "[diagnosis]\nwindows = [0.15, 2]\n", "prediction_horizon",
       "controller.prediction_horizon: found 20 (the shortest moving window has 3 samples); allowed: windows "
       "of at least 4 samples"},
      {"", "[diagnosis]\nwindows = [0.51, 0.54]\n", "windows",
       "diagnosis.windows: found [0.51, 0.54]; allowed: a whole number of samples between them, at a "
       "prediction horizon of 20 samples"},
      {"", "[diagnosis]\nwindow_stride = 0\n", "window_stride",
       "diagnosis.window_stride: found 0; allowed: a whole number from 1 to 100000"},
      {"", "[diagnosis]\nsource_population = 'all'\n", "source_population",
       "diagnosis.source_population: found 'all'; allowed: impactful, feasible"},
      {"", "[aggregate]\nconfidence = 1\n", "confidence",
       "aggregate.confidence: found 1; allowed: a number in (0, 1)"},
      {"", "[aggregate]\nconfidence = 0.0\n", "confidence",
       "aggregate.confidence: found 0.0; allowed: a number in (0, 1)"},
      {"", "[aggregate]\nbootstrap_replications = 99\n", "bootstrap_replications",
       "aggregate.bootstrap_replications: found 99; allowed: a whole number from 100 to 1000000"},
  });
}

TEST_CASE("what a study costs in memory has bounds that name their key", "[study_file]") {
  const std::string allowed = "; allowed: draws with which no channel looks back over more than 1000000";
  check_refusals({
      {"", "\n[world]\ndead_time_factor = {log_uniform = [1, 1e6]}\n", "dead_time_factor",
       "world.dead_time_factor: found draws up to 1000000 (level/hot then looks back over 3e+06 samples)" +
           allowed},
      {"", "\n[world]\ndead_time_shift = {normal = [0, 1e6]}\n", "dead_time_shift",
       "world.dead_time_shift: found draws up to 10000000 (level/hot then looks back over 1e+07 samples)" +
           allowed},
      {"", "\n[mismatch]\ndead_time_shift = {uniform = [0, 2e6]}\n", "dead_time_shift",
       "mismatch.dead_time_shift: found draws up to 2000000 (level/hot then looks back over 2e+06 samples)" +
           allowed},
      {"slack_weight = 9", "slack_weight = 9\nanalyser_delay = 60", "[controller]",
       "controller.cv.heat.analyser_delay: found 60 samples; allowed: fewer than the 60 of the record "
       "(simulation.samples), which ends before the first analysis is there"},
  });
  // A further lag behind coefficients of a step response has coefficients until it has settled.
  const std::string coefficients =
      replaced(small_study(), "gain = 2\ntime_constant = 10\ndead_time = 3",
               "step = [0.2, 0.8, 1.3, 1.6, 1.8, 1.9, 1.95, 1.98, 1.99, 2.0]\nstep_interval = 1");
  CHECK(refusal(coefficients + "\n[world]\nextra_lag = {log_uniform = [1e-6, 1]}\n") == "accepted");
  for (const char* draws : {"[world]\nextra_lag = {log_uniform = [1e-6, 1e6]}",
                            "[world]\ntime_constant_factor = {log_uniform = [1, 1e6]}",
                            "[world]\ntime_constant_factor = {log_uniform = [1e-6, 1]}\n"
                            "extra_lag = {uniform = [0, 1]}",
                            "[mismatch]\ntime_constant_factor = {log_uniform = [1, 1e6]}",
                            "[mismatch]\nparameter_weights = {gain = 1, time_constant = 1, dead_time = 1, "
                            "second_order = 1}\nsecond_order = {log_uniform = [1, 1e6]}"}) {
    INFO(draws);
    CHECK(refusal(coefficients + "\n" + draws + "\n").find(allowed) != std::string::npos);
  }
  std::string many = replaced(replaced(small_study(), "prediction_horizon = 20", "prediction_horizon = 2000"),
                              "control_horizon = 5", "control_horizon = 2000");
  for (int i = 0; i < 20; ++i) {
    const std::string name = "m" + std::to_string(i);
    many =
        replaced(many, "[[plant.md]]", "[[plant.mv]]\nname = \"" + name + "\"\nunit = \"1\"\n\n[[plant.md]]");
    many += "\n[controller.mv." + name + "]\nmove_suppression = 1\nhard = [-1, 1]\n";
  }
  CHECK(refusal(many) ==
        "s.toml:" + std::to_string(line_of(many, "control_horizon")) +
            ": controller.control_horizon: found 2000 (44000 moves and 4000 predicted outputs); "
            "allowed: at most 243 with this plant and prediction horizon: a quadratic program of "
            "5e+07 numbers");
}

}  // namespace
TEST_CASE("faults beyond one parameter and white noise are checked", "[study_file]") {
  check_refusals({
      {"", "[mismatch]\nextent_weights = {parameter = 0}\n", "extent_weights",
       "mismatch.extent_weights: found weights that are all 0; allowed: at least one > 0"},
      {"", "[mismatch]\nchannels = [\"level/heat\"]\n", "channels",
       "mismatch.channels: found 'level/heat' (nearest: 'level/hot'); allowed: level/hot, heat/cold"},
      {"", "[mismatch]\nchannels = []\n", "channels",
       "mismatch.channels: found a list of 0; allowed: a list of one or more of level/hot, heat/cold"},
      {"", "[mismatch]\nchannels = [\"heat/cold\", \"heat/cold\"]\n", "channels",
       "mismatch.channels: found 'heat/cold' twice; allowed: every name once"},
      {"", "[disturbance]\ncvs = [\"hot\"]\n", "cvs", "disturbance.cvs: found 'hot'; allowed: level, heat"},
      {"", "[disturbance]\ncvs = [\"level\"]\n", "cvs",
       "disturbance.cvs: found no 'heat', on which `mpm_ud` experiments have a mismatch and its disturbance; "
       "allowed: every CV of mismatch.channels, or mpm_ud = 0"},
      {"", "[mismatch]\nplant_parameter = [{name = \"a\"}]\n", "plant_parameter",
       "mismatch.plant_parameter: found parameters of a plant that is simulated with its linear model; "
       "allowed: "
       "plant.simulated = \"nonlinear\", plant.fmu or plant.program"},
      {"", "[mismatch]\nimpact = {uniform = [0, 1]}\n", "impact",
       "mismatch.impact: found draws from 0 to 1; allowed: a distribution whose every draw is a number > 0"},
      {"", "[disturbance]\nsignal_weights = {sine = 1, saw = 1}\n", "signal_weights",
       "disturbance.signal_weights: found unknown key 'saw'; allowed: white, step, ramp, random_walk, sine, "
       "burst"},
      {"", "[disturbance]\nplace_weights = {cv = -1}\n", "place_weights",
       "disturbance.place_weights.cv: found -1; allowed: a number >= 0"},
      {"mpm_ud = 1\n", "mpm_ud = 1\nother = 2\n[other]\nweights = {md_gain = 0}\n", "weights",
       "other.weights: found a weight of 0 for everything that the loops can have; allowed: at least one > "
       "0"},
      {"", "[onset]\nsample = {uniform = [0, 61]}\n", "sample = {uniform = [0, 61]",
       "onset.sample: found draws up to 61; allowed: draws below 60, the samples of the record"},
      {"", "[onset]\ngrowth = {uniform = [-1, 1]}\n", "growth",
       "onset.growth: found draws from -1 to 1; allowed: a distribution whose every draw is a number >= 0"},
  });
}

}  // namespace mpm
