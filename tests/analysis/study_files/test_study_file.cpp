
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/study_files/study_file.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

Study small_with(const std::string& from, const std::string& to) {
  return parse_study(replaced(small_study(), from, to), "s.toml");
}

/// Small with tables added at its end.
Study small_and(const std::string& more) {
  return parse_study(small_study() + more, "s.toml");
}

TEST_CASE("every value of the small study lands in its place", "[study_file]") {
  const std::string text = small_study();
  const Study study = parse_study(text, "s.toml");
  CHECK(study.name == "small");
  CHECK(study.title == "A small study");
  CHECK(study.seed == 7);
  CHECK(study.source == text);

  const MpcOptions& controller = study.controller;
  CHECK(controller.sample_time == 1);
  CHECK(controller.prediction_horizon == 20);
  CHECK(controller.control_horizon == 5);
  CHECK(controller.mv_cost == Eigen::Vector2d(-1, 6));
  CHECK(controller.move_suppression == Eigen::Vector2d(2, 7));
  CHECK(controller.target_weight == Eigen::Vector2d(3, 0));
  CHECK(controller.mv_hard.lower == Eigen::Vector2d(-4, -kInfinity));
  CHECK(controller.mv_hard.upper == Eigen::Vector2d(5, kInfinity));
  CHECK(controller.slack_weight == Eigen::Vector2d(8, 9));
  CHECK(controller.cv_soft.lower == Eigen::Vector2d(0, -kInfinity));
  CHECK(controller.cv_soft.upper == Eigen::Vector2d(1, 0.5));
  CHECK(controller.cv_hard.lower == Eigen::Vector2d(-2, -kInfinity));
  CHECK(controller.cv_hard.upper == Eigen::Vector2d(2, 3));

  CHECK(study.simulation.samples == 60);
  CHECK(study.simulation.noise_standard_deviation == Eigen::Vector2d(0.01, 0.01));
  CHECK_FALSE(study.simulation.random_steps);
  CHECK(study.experiments.mpm == 3);
  CHECK(study.experiments.ud == 2);
  CHECK(study.experiments.mpm_ud == 1);
}

TEST_CASE("the steps of a study come in the order of time", "[study_file]") {
  const Study study = parse_study(small_study(), "s.toml");  // the file has them the other way round
  REQUIRE(study.simulation.steps.size() == 2);
  CHECK(study.simulation.steps[0].sample == 10);
  CHECK(study.simulation.steps[0].level == 0.5);
  CHECK(study.simulation.steps[1].sample == 30);
  CHECK(study.simulation.steps[1].level == -0.25);
  CHECK(study.simulation.steps[0].variable == 0);
}

TEST_CASE("keys that are left out have the defaults of Study", "[study_file]") {
  const Study study = parse_study(small_study(), "s.toml");
  const Study defaults;
  CHECK(study.controller.weight_convention == defaults.controller.weight_convention);
  CHECK(study.controller.slack_form == defaults.controller.slack_form);
  CHECK(study.controller.target_violation_cost == defaults.controller.target_violation_cost);
  CHECK(study.controller.solver_time_limit == defaults.controller.solver_time_limit);
  CHECK(study.mismatch.parameter_weight == defaults.mismatch.parameter_weight);
  CHECK(study.mismatch.gain_factor == defaults.mismatch.gain_factor);
  CHECK(study.mismatch.time_constant_factor == defaults.mismatch.time_constant_factor);
  CHECK(study.mismatch.dead_time_shift == defaults.mismatch.dead_time_shift);
  CHECK(study.disturbance.gain == defaults.disturbance.gain);
  CHECK(study.disturbance.time_constant == defaults.disturbance.time_constant);
  CHECK(study.disturbance.v_standard_deviation == defaults.disturbance.v_standard_deviation);
  CHECK(study.sensitivity.samples == defaults.sensitivity.samples);
  CHECK(study.sensitivity.step_size == defaults.sensitivity.step_size);
  CHECK(study.sensitivity.active_cvs.empty());
  CHECK(study.s0_perturbation.multipliers.empty());
  CHECK(study.s0_perturbation.fixed_mvs.empty());
  CHECK(study.diagnosis.impact_lower == defaults.diagnosis.impact_lower);
  CHECK(study.diagnosis.impact_upper == defaults.diagnosis.impact_upper);
  CHECK(study.diagnosis.location_distance == defaults.diagnosis.location_distance);
  CHECK(mpm_threshold(study) == mpm_threshold(defaults));
  CHECK(study.diagnosis.shortest_window == defaults.diagnosis.shortest_window);
  CHECK(study.diagnosis.longest_window == defaults.diagnosis.longest_window);
  CHECK(study.diagnosis.window_stride == defaults.diagnosis.window_stride);
  CHECK(study.diagnosis.source_population == defaults.diagnosis.source_population);
  CHECK(study.diagnosis.self_check_lower == defaults.diagnosis.self_check_lower);
  CHECK(study.diagnosis.self_check_upper == defaults.diagnosis.self_check_upper);
  CHECK(study.aggregate.confidence == defaults.aggregate.confidence);
  CHECK(study.aggregate.bootstrap_replications == defaults.aggregate.bootstrap_replications);
}

TEST_CASE("the optional keys of the controller land in their place", "[study_file]") {
  const Study study = small_with("control_horizon = 5",
                                 "control_horizon = 20\nweight_convention = 'squared'\nslack = 'per-cv'\n"
                                 "target_violation_cost = 50\nsolver_time_limit = 0.5");
  CHECK(study.controller.control_horizon == 20);
  CHECK(study.controller.weight_convention == WeightConvention::squared);
  CHECK(study.controller.slack_form == SlackForm::per_cv);
  CHECK(study.controller.target_violation_cost == 50);
  CHECK(study.controller.solver_time_limit == 0.5);
}

TEST_CASE("the keys of s0_perturbation land in their place", "[study_file]") {
  const S0PerturbationOptions options =
      parse_study(small_study() +
                      "\n[s0_perturbation]\nmultipliers = [0.5, 1, 2]\ncvs = ['heat']\n"
                      "tolerance = [0.9, 1.2]\nfixed_mvs = ['cold']\n"
                      "fixed_active_cvs = ['level']\n",
                  "s.toml")
          .s0_perturbation;
  CHECK(options.multipliers == std::vector<double>{0.5, 1, 2});
  CHECK(options.cvs == std::vector<Eigen::Index>{1});
  CHECK(options.tolerance_lower == 0.9);
  CHECK(options.tolerance_upper == 1.2);
  CHECK(options.fixed_mvs == std::vector<Eigen::Index>{1});
  CHECK(options.fixed_active_cvs == std::vector<Eigen::Index>{0});
}

TEST_CASE("what a method cannot take is refused where it stands, whether or not it is asked",
          "[study_file]") {
  const std::string table = "\n[assessment.badwe2010]\n";
  check_refusals({
      {"", table + "criterion = 'aic'\n", "criterion",
       "assessment.badwe2010.criterion: found 'aic' (nearest: 'bic'); allowed: record-fit, validation-fit, "
       "bic"},
      {"", table + "max_iterations = 0\n", "max_iterations",
       "assessment.badwe2010.max_iterations: found 0; allowed: a whole number from 1 to 100000"},
      {"", table + "smallest_order = 5\nlargest_order = 4\n", "largest_order",
       "assessment.badwe2010.largest_order: found 4; allowed: a whole number from 5 to 100"},
  });
}

TEST_CASE("noise can differ between the CVs, by their names", "[study_file]") {
  const Study study = small_with("deviation = 0.01", "deviation = {heat = 0.2, level = 0}");
  CHECK(study.simulation.noise_standard_deviation == Eigen::Vector2d(0, 0.2));
}

TEST_CASE("random steps take the place of the list", "[study_file]") {
  std::string text = small_study();
  const std::size_t begin = text.find("[[simulation.step]]");
  text.replace(begin, text.find("[experiments]") - begin,
               "[simulation.random_steps]\ninterval = {uniform = [5, 9]}\nlevel = {normal = [0, 0.3]}\n");
  const SimulationOptions simulation = parse_study(text, "s.toml").simulation;
  CHECK(simulation.random_steps);
  CHECK(simulation.steps.empty());
  CHECK(simulation.step_interval == Distribution::uniform(5, 9));
  CHECK(simulation.step_level == Distribution::normal(0, 0.3));
}

TEST_CASE("the ranges of mismatch and disturbance land in their place", "[study_file]") {
  const Study study = small_and(
      "[mismatch]\nparameter_weights = {gain = 2, time_constant = 0, dead_time = 0.5}\n"
      "gain_factor = {constant = 0.5}\ntime_constant_factor = {log_uniform = [0.2, 5]}\n"
      "dead_time_shift = {normal = [0.5, 2]}\n"
      "[disturbance]\ngain = {uniform = [1, 2]}\ntime_constant = {constant = 40}\nv_standard_deviation = "
      "3\n");
  CHECK(study.mismatch.parameter_weight == std::array<double, 6>{2, 0, 0.5, 0, 0, 0});
  CHECK(study.mismatch.gain_factor == Distribution::constant(0.5));
  CHECK(study.mismatch.time_constant_factor == Distribution::log_uniform(0.2, 5));
  CHECK(study.mismatch.dead_time_shift == Distribution::normal(0.5, 2));
  CHECK(study.disturbance.gain == Distribution::uniform(1, 2));
  CHECK(study.disturbance.time_constant == Distribution::constant(40));
  CHECK(study.disturbance.v_standard_deviation == 3);
}

TEST_CASE("the options of the analysis land in their place", "[study_file]") {
  const Study study = small_and(
      "[sensitivity]\nsamples = 33\nstep_size = 0.2\nactive_cvs = ['heat', 'level']\n"
      "[diagnosis]\nimpact_band = [0.7, 1.4]\nlocation_distance = 'logarithmic'\nmpm_threshold = 0.2\n"
      "windows = [0.4, 1.5]\nwindow_stride = 3\nsource_population = 'feasible'\nself_check_band = [0.6, "
      "1.6]\n"
      "[aggregate]\nconfidence = 0.9\nbootstrap_replications = 100\n");
  CHECK(study.sensitivity.samples == 33);
  CHECK(study.sensitivity.step_size == 0.2);
  CHECK(study.sensitivity.active_cvs == std::vector<Eigen::Index>{1, 0});
  CHECK(study.diagnosis.impact_lower == 0.7);
  CHECK(study.diagnosis.impact_upper == 1.4);
  CHECK(study.diagnosis.location_distance == LocationDistance::logarithmic);
  CHECK(mpm_threshold(study) == 0.2);
  CHECK(study.diagnosis.shortest_window == 0.4);
  CHECK(study.diagnosis.longest_window == 1.5);
  CHECK(study.diagnosis.window_stride == 3);
  CHECK(study.diagnosis.source_population == SourcePopulation::feasible);
  CHECK(study.diagnosis.self_check_lower == 0.6);
  CHECK(study.diagnosis.self_check_upper == 1.6);
  CHECK(study.aggregate.confidence == 0.9);
  CHECK(study.aggregate.bootstrap_replications == 100);
}

TEST_CASE("a plant defined in the file has its variables and channels", "[study_file]") {
  const PlantModel plant = parse_study(small_study(), "s.toml").plant;
  CHECK(plant.name == "mixer");
  CHECK(plant.title == "A mixer");
  CHECK(plant.time_unit == "s");
  REQUIRE(plant.cvs.size() == 2);
  REQUIRE(plant.mvs.size() == 2);
  REQUIRE(plant.mds.size() == 1);
  CHECK(plant.cvs[0].description == "Level in the tank");
  CHECK(plant.cvs[1].unit == "K");
  CHECK(plant.mds[0].name == "drain");
  CHECK(plant.G(0, 0).numerator() == Eigen::VectorXd::Constant(1, 2));
  CHECK(plant.G(0, 0).denominator() == Eigen::Vector2d(10, 1));
  CHECK(plant.G(0, 0).dead_time() == 3);
  CHECK(plant.G(1, 1).numerator() == Eigen::VectorXd::Constant(1, -1.5));
  CHECK(plant.G(1, 1).denominator() == Eigen::Vector3d(20, 12, 1));
  CHECK(plant.G(1, 1).dead_time() == 2);
  CHECK(plant.G(0, 2).static_gain() == -1);
  CHECK(plant.G(0, 2).dead_time() == 0);  // left out
  CHECK(plant.G(0, 1).is_zero());
  CHECK(plant.G(1, 0).is_zero());
  CHECK(plant.G(1, 2).is_zero());
}

std::string variable_tables(const std::string& list, const std::vector<PlantModel::Variable>& variables) {
  std::string text;
  for (const PlantModel::Variable& variable : variables) {
    text += "[[plant." + list + "]]\nname = '" + variable.name + "'\nunit = '" + variable.unit +
            "'\ndescription = '" + variable.description + "'\n";
  }
  return text;
}

/// The plant as a study file writes it, channel by channel.
std::string spelled_out(const PlantModel& plant) {
  std::vector<PlantModel::Variable> inputs = plant.mvs;
  inputs.insert(inputs.end(), plant.mds.begin(), plant.mds.end());
  std::string text = "[plant]\nname = '" + plant.name + "'\ntitle = '" + plant.title + "'\ntime_unit = '" +
                     plant.time_unit + "'\n" + variable_tables("cv", plant.cvs) +
                     variable_tables("mv", plant.mvs) + variable_tables("md", plant.mds);
  for (Eigen::Index row = 0; row < plant.G.rows(); ++row) {
    for (Eigen::Index col = 0; col < plant.G.cols(); ++col) {
      const TransferFunction& channel = plant.G(row, col);
      text += "[[plant.channel]]\ncv = '" + plant.cvs[static_cast<std::size_t>(row)].name + "'\ninput = '" +
              inputs[static_cast<std::size_t>(col)].name +
              "'\ngain = " + std::to_string(channel.static_gain()) +
              "\ntime_constant = " + std::to_string(channel.denominator()(0)) +
              "\ndead_time = " + std::to_string(channel.dead_time()) + "\n";
    }
  }
  return text;
}

TEST_CASE("step coefficients are the model as they are", "[study_file]") {
  // An inverse response and five lags.
  const TransferFunction slow(Eigen::Vector2d(-40, 2),
                              (Eigen::VectorXd(6) << 3125, 3125, 1250, 250, 25, 1).finished());
  const Eigen::VectorXd values = step_response(TransferMatrix{{slow}}, 1, 120).front().row(0);
  std::string list;
  for (const double value : values)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", value);
  const Study study = parse_study(
      replaced(small_study(), "numerator = [-1.5]\ndenominator = [20.0, 12.0, 1.0]\ndead_time = 2",
               "step = [" + list + "]\nstep_interval = 1"),
      "s.toml");
  const auto [cv, input, error] = study.plant.step_fits.at(0);
  CHECK(error > 0.01);
  const TransferMatrix channel{{study.plant.G(cv, input)}};
  CHECK(step_response(channel, study.controller.sample_time, 120).front().row(0).transpose() == values);
  CHECK(channel.static_gain()(0, 0) == values(119));
}

TEST_CASE("a plant of the catalogue spelled out in the file is the same plant", "[study_file]") {
  const PlantModel expected = benchmark_plant("shell-7x3");
  const std::string text = project_file("scenarios/studies/chapter6.toml");
  const std::size_t begin = text.find("[plant]");
  const std::size_t end = text.find("[controller]");
  const PlantModel plant =
      parse_study(text.substr(0, begin) + spelled_out(expected) + text.substr(end), "s.toml").plant;
  CHECK(plant.name == expected.name);
  CHECK(plant.title == expected.title);
  REQUIRE(plant.cvs.size() == expected.cvs.size());
  for (std::size_t i = 0; i < expected.cvs.size(); ++i) {
    CHECK(plant.cvs[i].name == expected.cvs[i].name);
    CHECK(plant.cvs[i].description == expected.cvs[i].description);
  }
  // Equal to the last bit: to_string() writes these numbers, of two decimals at most, exactly.
  CHECK(plant.G.static_gain() == expected.G.static_gain());
  const std::complex<double> s(0, 0.03);
  CHECK(plant.G.frequency_response(s) == expected.G.frequency_response(s));
}

TEST_CASE("a plant without measured disturbances needs no excitation", "[study_file]") {
  std::string text = small_study();
  const auto cut = [&text](const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    text.erase(begin, text.find(to, begin) - begin);
  };
  cut("[[plant.md]]", "[[plant.channel]]");
  cut("[[plant.channel]]\ncv = \"level\"\ninput = \"drain\"", "[controller]");
  cut("[[simulation.step]]", "[experiments]");
  const Study study = parse_study(text, "s.toml");
  CHECK(study.md_count() == 0);
  CHECK(study.plant.G.cols() == 2);
  CHECK(study.simulation.steps.empty());
}

}  // namespace
}  // namespace mpm
