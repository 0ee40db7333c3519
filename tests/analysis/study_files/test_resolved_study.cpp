#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <toml++/toml.h>

#include "analysis/methods/literature/badwe2009.hpp"
#include "analysis/study_files/resolved_study.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_file_keys.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/study_variant.hpp"
#include "analysis/study_files/sweep_file.hpp"
#include "analysis/study_files/table_file.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"
#include "tests/scenarios/study_texts.hpp"

// The text of a study with every default written out.

namespace mpm {
namespace {

namespace fs = std::filesystem;

using namespace testing;

using Keys = std::set<std::pair<std::string, std::string>>;  // table as in study_file_tables(), key

std::vector<fs::path> toml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The variants of a study that a table file makes.
void add_variants(const fs::path& table_file, std::vector<Study>& studies) {
  const std::string name = table_file.string();
  const toml::table toml = parse_toml(read_toml_file(table_file, "a table file"), name);
  const TomlTable document(toml, name, {"table", "variant", "column", "rule", "row"});
  if (!document.has("variant"))
    return;
  const TomlTable heading =
      document.table("table", {"chapter", "number", "figure", "title", "study", "note"});
  const Study base = read_base_study(heading, table_file.parent_path());
  const toml::table text = parse_toml(base.source, name);
  for (const TomlTable& variant : document.tables("variant", {"name", "study", "remove", "set"}))
    if (!variant.has("study"))  // another shipped study, which is here anyway
      studies.push_back(read_study_variant(variant, text, name));
}

/// Every study that the program comes with.
std::vector<Study> shipped() {
  std::vector<Study> studies;
  for (const fs::path& file : toml_files(study_directory()))
    studies.push_back(load_study(file));
  for (const fs::path& file : toml_files(table_directory()))
    add_variants(file, studies);
  for (const fs::path& file : toml_files(study_directory().parent_path() / "sweeps"))
    for (SweepVariant& variant : load_sweep(file).variants)
      studies.push_back(std::move(variant.study));
  return studies;
}

/// The small study with every reported number and with keys of random experiments that shipped studies leave
/// out.
std::string random_study_text() {
  std::string text = replaced(small_study(), "[controller.cv.level]\n",
                              "[controller.cv.level]\nsetpoint_weight = 4\nsetpoint = 0.1\n");
  text = replaced(text, "control_horizon = 5", "control_horizon = 5\nsolver_time_limit = 4");
  text = replaced(
      text, "noise_standard_deviation = 0.01",
      "noise_standard_deviation = {level = 0.01, heat = 0.3}\n"
      "noise = {distribution = 'student', autocorrelation = -0.3, factor = {log_uniform = [0.5, 2]}}\n"
      "md_noise = {standard_deviation = 0.1, time_constant = 3}\n"
      "limit_step = [{cv = 'heat', sample = 9, soft = [-inf, 0.4]}]\n"
      "dither = [{mv = 'cold', amplitude = 0.1, hold = 4}]\n"
      "off = [{mv = 'hot', sample = 7, samples = 5}, {mv = 'hot', sample = 12, samples = 3, level = 0.3}, "
      "{cv = 'heat', sample = 4, samples = 30}]\n"
      "[[simulation.step]]\ncv = \"level\"\nsample = 5\nlevel = 0.2\n");
  text +=
      "healthy = 4\ntuning = 5\nother = 6\n"
      "[other]\nimpact = {constant = 1.5}\nweights = {stiction = 1, limit = 2}\n"
      "[record]\nquantisation = 0.5\ncompression = 2\noutliers = {share = 0.01, size = {constant = 7}}\n"
      "candidates = {count = 3, share = 0.4}\n"
      "missing = {share = 0.1, length = 4, fill = 'hold'}\n"
      "shift = {level = -0.5, drain = 1}\nbad = {share = 0.1, value = 'off_scale', quality = true}\n"
      "[disturbance]\ncvs = ['heat', 'level']\nimpact = {uniform = [0.5, 2]}\nsignal_weights = {sine = 1}\n"
      "[mismatch]\nchannels = ['heat/cold']\nimpact = {log_uniform = [0.5, 2]}\nparameter_weights = {gain = "
      "1, time_constant = 0, "
      "dead_time = 0.1}\n"
      "dead_time_shift = {normal = [0.1, 0.5]}\ngain_factor = {constant = 0.7}\n"
      "[tuning]\nparameter_weights = {move_suppression = 1, target_weight = 2, slack_weight = 3, "
      "setpoint_weight = 4}\n"
      "[sensitivity]\nactive_cvs = ['level']\nfixed_mvs = ['cold']\n"
      "[s0_perturbation]\ncvs = ['level']\nfixed_mvs = ['hot']\nfixed_active_cvs = ['heat']\n"
      "multipliers = [0.25";
  for (int i = 1; i < 80; ++i)
    text += ", " + std::to_string(0.25 + 0.1 * i) + (i % 30 == 0 ? "\n" : "");
  text +=
      "]\n[monitoring]\nwindow = 30\nstride = 7\n[calibration]\nhealthy = 50\nseed = 8\n"
      "[data]\ntime = 'stamp'\ndate = 'day'\ntime_format = '%H:%M'\ntime_zone = 'Europe/Berlin'\nlanguage = "
      "'it'\nskip = [2, "
      "4]\n"
      "tag_column = 'tag'\nvalue_column = 'value'\nstored_on_change = ['hot']\ntime_unit = 'h'\ndate_order = "
      "'day-month-year'\nseparator = ';'\ndecimal = "
      "','\n"
      "tags = {level = 'LI 1', drain = 'FI 3'}\noperating_point = {heat = 80.5}\nscale = {hot = -2}\n"
      "setpoint = {level = 'LC 1'}\nlower = {level = 'lo'}\nupper = {heat = 'hi'}\ny_sim = {heat = 'model'}\n"
      "target = {hot = 'best'}\nmode = {hot = 'm', heat = 'n'}\nmode_on = ['in']\nquality = {level = "
      "'q'}\ngood_quality = ['ok']\ncontroller_on = 'on'\n"
      "on_values = ['yes']\ncv_resampling = 'nearest'\nstart = 'rest'\nmost_missing = 0.5\nfill = 'hold'\n"
      "candidates = ['FI 9']\n"
      "period = ['0', '9']\nbenchmark = ['1', '4']\n[reference]\n";
  for (const std::string& key : key_names(study_file_keys("reference")))
    text += "\"" + key + "\" = 0.123\n";
  text += "share = {value = 0.5, of = 7}\n";
  return text;
}

/// The small study with a title that has to be quoted with care, random steps, and faults in all forms.
std::string scenario_study_text() {
  std::string text = replaced(small_study(), "\"A small study\"", "'A \"small\" study \\o/'");
  text = text.substr(0, text.find("[[simulation.step]]")) +
         "[simulation.random_steps]\nlevel = {uniform = [-1, 1]}\n";
  return text + R"(
[[scenario]]
name = "healthy"
description = "nothing is wrong"

[[scenario]]
name = "plant"
affected = []
mismatch = [{cv = "level", input = "hot", gain_factor = 0.5, time_constant_factor = 2, dead_time_shift = -1},
            {cv = "heat", input = "hot", gain = 1, time_constant = 3},
            {cv = "level", input = "drain", numerator = [-1], denominator = [3, 1], dead_time = 0.1}]

[[scenario]]
name = "disturbances"
affected = ["heat", "level"]

[[scenario.disturbance]]
cv = "level"
gain = 0.1
time_constant = 0.3

[[scenario.disturbance]]
cv = "level"
numerator = [1]
denominator = [2, 0]
dead_time = 4
white = 2
hold = 3

[[scenario.disturbance]]
cv = "heat"
sine = {amplitude = 0.1, period = 7}

[[scenario.disturbance]]
cv = "heat"
ramp = {slope = 0.01}

[[scenario.disturbance]]
cv = "heat"
steps = [{sample = 3, level = 1}, {sample = 9, level = 0}]
)";
}

/// The nonlinear tank with changed parameters and a disturbance of an inner input.
std::string nonlinear_study_text() {
  std::string text = project_file("tests/scenarios/data/quadruple-tank.toml");
  text = replaced(text, "catalogue = \"quadruple-tank\"\n",
                  "catalogue = \"quadruple-tank\"\nsimulated = \"nonlinear\"\nrelative_tolerance = 1e-7\n");
  return text.substr(0, text.find("[experiments]")) + R"(
[[scenario]]
name = "tank"
affected = ["h1"]
parameter = [{name = "cd1", value = 7.86}, {name = "A4", factor = 0.125}]
disturbance = [{input = "D4", gain = 8, time_constant = 70}]
)";
}

/// The same with random changes of its parameters.
std::string random_tank_text() {
  return replaced(
      replaced(project_file("tests/scenarios/data/quadruple-tank.toml"), "catalogue = \"quadruple-tank\"\n",
               "catalogue = \"quadruple-tank\"\nsimulated = \"nonlinear\"\n"),
      "[experiments]", R"([mismatch]
plant_parameter = [{name = "cd1", factor = {uniform = [0.8, 1.2]}, affected = ["h1"]},
                   {name = "k2", factor = {constant = 0.9}, affected = ["h2", "h3"]}]

[experiments])");
}

/// The same as an FMU, which need not be there.
std::string fmu_study_text() {
  return replaced(random_tank_text(), "simulated = \"nonlinear\"\n", R"(
[plant.fmu]
file = "not_here.fmu"
settle = 3000
step = 0.25
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", variable = "valve.2", operating = 0.34}]
output = [{name = "h1", variable = "level[1]"}]
parameter = [{name = "cd1", value = 3.145}, {name = "k2", value = 3.29}]

)");
}

/// The same as a program.
std::string program_study_text() {
  return replaced(random_tank_text(), "simulated = \"nonlinear\"\n", R"(
[plant.program]
command = ["tank", "--fast", "--fast"]
settle = 3000
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", operating = 0.34}]
parameter = [{name = "cd1", value = 3.145}, {name = "k2", value = 3.29}]

)");
}

/// The small study with a controller of somebody else.
std::string controller_program_text() {
  return replaced(small_study(), "[controller.mv.hot]",
                  "[controller.program]\ncommand = [\"mpc\", \"\", \"mpc\"]\n\n[controller.mv.hot]");
}

/// The small study in which nothing but noise and faults moves the loop.
std::string unexcited_study_text() {
  const std::string text = small_study();
  return text.substr(0, text.find("[[simulation.step]]")) +
         "excitation = 'none'\n[experiments]\nmpm = 1\nud = 1\nmpm_ud = 0\n";
}

/// The small study in worlds, with an excitation of its own in each loop.
std::string world_study_text() {
  return replaced(small_study(), "samples = 60", "samples = 60\nexcitation = \"each\"") +
         "\n[assessment.likelihood]\nhypotheses = \"all\"\n[assessment.arx-oe]\nform = \"windows\"\nwindow = "
         "300\nstep = 50\nnu = 0.02\nshare = 0.4\n[calibration]\nhealthy = 6\nworlds = 5\n[world]\ncount = "
         "3\ngain_factor = {uniform = "
         "[0.95, 1.05]}\n"
         "background = {cv_size = {constant = 0.5}, time_constant = {constant = 10}}\n";
}

/// The tank in worlds.
std::string world_tank_text() {
  return random_tank_text() +
         "\n[world]\nplant_parameter = [{name = \"cd1\", factor = {uniform = [0.95, 1.05]}}]\n";
}

/// The small study with the limits, tunings and analysers of industrial controllers.
std::string tuned_study_text() {
  std::string text =
      replaced(small_study(), "control_horizon = 5", "control_horizon = 3\nmove_blocks = [1, 4, 2]");
  text = replaced(text, "[controller.mv.hot]\ncost = -1",
                  "[controller.mv.hot]\nresting_value = 0.5\nresting_weight = 2");
  text = replaced(text, "hard = [-4, 5]", "hard = [-4, 5]\nmove_limit = 0.5");
  text = replaced(text, "slack_weight = 8\nsoft = [0, 1]", "setpoint_weight = 1\nreference_time = 4");
  text += "\n[controller.md.drain]\nanalyser_period = 3\nanalyser_delay = 2\n";
  return replaced(text, "slack_weight = 9",
                  "slack_weight = 9\nslack_cost = 6\nanalyser_period = 5\nanalyser_delay = 3");
}

/// The channels as coefficients of step responses.
std::string stepped_study_text() {
  const std::string lag =
      "step = [0.3935, 0.6321, 0.7769, 0.8647, 0.9179, 0.9502, 0.9698, 0.9817, 0.9889, 0.9933]";
  const std::string text =
      replaced(scenario_study_text(), "numerator = [-1.5]\ndenominator = [20.0, 12.0, 1.0]\ndead_time = 2",
               lag + "\nstep_interval = 2");
  return replaced(replaced(text, "numerator = [-1], denominator = [3, 1], dead_time = 0.1",
                           lag + ", step_interval = 0.5"),
                  "numerator = [1]\ndenominator = [2, 0]\ndead_time = 4", lag + "\nstep_interval = 1");
}

/// The level integrates, in the model, a scenario and a disturbance.
std::string level_study_text() {
  std::string text = replaced(scenario_study_text(), "gain = 2\ntime_constant = 10\ndead_time = 3",
                              "rate_gain = 2\ntime_constant = 10\ndead_time = 3");
  text =
      replaced(text, "slack_weight = 8\nsoft = [0, 1]", "slack_weight = 8\nsoft = [0, 1]\nbias_ramp = 0.2");
  text += "\n[assessment]\nwashout = 30\n";
  text = replaced(text, "numerator = [-1], denominator = [3, 1], dead_time = 0.1",
                  "rate_gain = -1, dead_time = 0.1");
  return replaced(text, "numerator = [1]\ndenominator = [2, 0]\ndead_time = 4",
                  "rate_gain = 0.5\ndead_time = 4");
}

/// Studies of the tests, among them those with the keys that no shipped one has.
std::vector<Study> of_tests() {
  std::vector<Study> studies;
  for (const std::string& text :
       {small_study(), random_study_text(), scenario_study_text(), nonlinear_study_text(), random_tank_text(),
        fmu_study_text(), program_study_text(), controller_program_text(), unexcited_study_text(),
        world_study_text(), world_tank_text(), tuned_study_text(), stepped_study_text(), level_study_text()})
    studies.push_back(parse_study(text, "s.toml"));
  return studies;
}

bool is_known(const std::string& table) {
  const std::vector<KeyTable>& tables = study_file_tables();
  return std::any_of(tables.begin(), tables.end(),
                     [&](const KeyTable& known) { return known.name == table; });
}

/// The keys in `table`, which stands under `name`, and below it.
void collect(const toml::table& table, const std::string& name, Keys& keys) {
  for (const auto& [key, node] : table) {
    keys.emplace(name, key.str());
    const std::string below = (name.empty() ? "" : name + ".") + std::string(key.str());
    if (const toml::array* const list = node.as_array(); list != nullptr && is_known(below + "[]"))
      for (const toml::node& entry : *list)
        collect(*entry.as_table(), below + "[]", keys);
    const toml::table* const inner = node.as_table();
    if (inner == nullptr || below == "simulation.noise_standard_deviation" || below == "record.shift" ||
        name == "data")
      continue;
    const std::string each = below + (below == "reference" ? ".FINDING" : ".NAME");
    if (is_known(each))
      for (const auto& [name_below, entry] : *inner)
        if (entry.is_table())
          collect(*entry.as_table(), each, keys);
    if (is_known(below) || !is_known(each))
      collect(*inner, is_known(below) ? below : "DISTRIBUTION", keys);
  }
}

Keys keys_of(const Study& study) {
  Keys keys;
  collect(parse_toml(resolved_study(study), "resolved"), "", keys);
  return keys;
}

void check_round_trip(const Study& study) {
  INFO(study.name << ": " << study.title);
  const std::string text = resolved_study(study);
  Study read = parse_study(text, "resolved " + study.name);
  CHECK(resolved_study(read) == text);
  CHECK(read.source == text);
  read.source = study.source;
  CHECK(read == study);
}

TEST_CASE("a resolved study is read as the same study", "[resolved_study]") {
  const std::vector<Study> studies = shipped();
  REQUIRE(studies.size() > 50);  // or the folders were not found
  for (const Study& study : studies)
    check_round_trip(study);
  for (const Study& study : of_tests())
    check_round_trip(study);
}

TEST_CASE("every key of a study file comes out in a resolved study", "[resolved_study]") {
  Keys written;
  for (const std::vector<Study>& studies : {shipped(), of_tests()})
    for (const Study& study : studies)
      written.merge(keys_of(study));
  for (const KeyTable& table : study_file_tables())
    for (const std::string& key : key_names(table.keys)) {
      INFO("in no resolved study; give a study in tests/scenarios/data the key: [" << table.name << "] "
                                                                                   << key);
      CHECK(written.count({table.name, key}) == 1);
    }
}

TEST_CASE("the lasting text has a later key where it is used, and is a study otherwise the same",
          "[resolved_study]") {
  const Study plain = find_study("wood-berry");
  const std::string text = lasting_text(plain), resolved = resolved_study(plain);
  const auto names = [](const std::string& in, const std::string& key) {
    return in.find("\n" + key + " = ") != std::string::npos;
  };
  for (const char* const key : {"impact", "valve_start", "sensor_stuck", "friction"}) {
    INFO(key);
    CHECK(names(resolved, key));
  }
  CHECK_FALSE(names(text, "valve_start"));
  CHECK_FALSE(names(text, "stick_slip"));
  CHECK(text.find("[diagnosis]\nimpact_band") != std::string::npos);
  CHECK(text.find("impact = \"variance\"") == std::string::npos);
  Study read = parse_study(text, "lasting");
  read.source = plain.source;
  CHECK(read == plain);
  const std::string used = plain.source + "\n[diagnosis]\nimpact = \"cost\"\n";
  CHECK(lasting_text(parse_study(used, "used")).find("impact = \"cost\"") != std::string::npos);
}

TEST_CASE("a resolved study has the defaults that its file leaves out", "[resolved_study]") {
  const Keys written = keys_of(parse_study(small_study(), "small.toml"));
  const Keys without_value{{"sensitivity", "active_cvs"}, {"sensitivity", "fixed_mvs"},
                           {"mismatch", "impact"},        {"mismatch", "plant_parameter"},
                           {"disturbance", "impact"},     {"other", "impact"},
                           {"mismatch", "channels"},      {"disturbance", "cvs"},
                           {"assessment", "washout"},     {"assessment", "arx-oe"}};
  for (const char* name : {"experiments",
                           "mismatch",
                           "mismatch.parameter_weights",
                           "mismatch.extent_weights",
                           "disturbance",
                           "disturbance.signal_weights",
                           "disturbance.place_weights",
                           "other",
                           "other.weights",
                           "onset",
                           "tuning",
                           "tuning.parameter_weights",
                           "sensitivity",
                           "diagnosis",
                           "assessment",
                           "assessment.sun",
                           "assessment.badwe2009",
                           "assessment.badwe2010",
                           "assessment.yu-qin",
                           "assessment.sse",
                           "assessment.counterfactual",
                           "assessment.order",
                           "assessment.excitation",
                           "assessment.candidates",
                           "assessment.mqi-channels",
                           "assessment.pmr",
                           "assessment.autocovariance",
                           "aggregate"})
    for (const std::string& key : key_names(study_file_keys(name))) {
      INFO("[" << name << "] " << key);
      CHECK(written.count({name, key}) != without_value.count({name, key}));
    }
  for (const char* key : {"weight_convention", "slack", "target_violation_cost"})
    CHECK(written.count({"controller", key}) == 1);
  CHECK(written.count({"controller", "solver_time_limit"}) == 0);  // digests of finished boards have none
  const std::string limited =
      replaced(small_study(), "control_horizon = 5", "control_horizon = 5\nsolver_time_limit = 4");
  CHECK_THAT(resolved_study(parse_study(limited, "s.toml")), Catch::Contains("\nsolver_time_limit = 4.0\n"));
}

TEST_CASE("a resolved study begins as the document of the study file does", "[resolved_study]") {
  const std::string text = resolved_study(parse_study(small_study(), "small.toml"));
  CHECK(
      text.starts_with("[study]\n"
                       "name = \"small\"\n"
                       "title = \"A small study\"\n"
                       "seed = 7\n"
                       "\n"
                       "[plant]\n"
                       "simulated = \"linear\"\n"
                       "name = \"mixer\"\n"
                       "title = \"A mixer\"\n"
                       "time_unit = \"s\"\n"
                       "\n"
                       "[[plant.cv]]\n"
                       "name = \"level\"\n"));
  CHECK_THAT(text, Catch::Contains("\n[controller.mv.cold]\ncost = 6.0\nmove_suppression = 7.0\n"
                                   "target_weight = 0.0\nhard = [-inf, inf]\n") &&
                       Catch::Contains("\ndenominator = [20.0, 12.0, 1.0]\n") &&
                       Catch::Contains("\ngain_factor = {uniform = [0.3, 1.5]}\n") &&
                       Catch::Contains("\norders = [20]\n"));
  const std::vector<std::string> order{"[study]",       "[plant]",     "[controller]",  "[simulation]",
                                       "[experiments]", "[mismatch]",  "[disturbance]", "[tuning]",
                                       "[sensitivity]", "[diagnosis]", "[assessment]",  "[aggregate]"};
  CHECK(std::is_sorted(order.begin(), order.end(), [&text](const std::string& a, const std::string& b) {
    return line_of(text, a) < line_of(text, b);
  }));
}

TEST_CASE("a resolved study has the seed in force", "[resolved_study]") {
  Study study = parse_study(small_study(), "small.toml");
  study.seed = 9223372036854775807U;
  CHECK(parse_study(resolved_study(study), "resolved").seed == study.seed);
  ++study.seed;  // no TOML file can have it
  CHECK(refusal(resolved_study(study)) ==
        "s.toml:1: study.seed: found nothing; allowed: a whole number from 0 to 9223372036854775807");
  CHECK_THAT(resolved_study(study), Catch::Contains("\n# seed: 9223372036854775808, above what"));
}

TEST_CASE("a study that is not what its text says is refused", "[resolved_study]") {
  Study study = parse_study(small_study(), "small.toml");
  study.simulation.samples += 1;
  CHECK_THROWS_WITH(
      resolved_study(study),
      "defaults of the study 'small': found a study that was changed after it was read; allowed: a "
      "study as its text says it, with any seed and methods");
}

TEST_CASE("studies differ by each part, and by the length of a vector", "[resolved_study]") {
  const Study study = parse_study(small_study(), "small.toml");
  const auto differs = [&study](auto change) {
    Study changed = study;
    change(changed);
    return changed != study;
  };
  CHECK_FALSE(differs([](Study&) {}));
  CHECK(differs([](Study& s) { s.plant.G(0, 0) = TransferFunction::zero(); }));
  CHECK(differs([](Study& s) { s.plant.cvs[1].unit = "C"; }));
  CHECK(differs([](Study& s) { s.controller.mv_cost(1) = 5; }));
  CHECK(differs([](Study& s) { s.controller.mv_cost.conservativeResize(1); }));
  CHECK(differs([](Study& s) { s.controller.cv_soft.upper(1) = 0.4; }));
  CHECK(differs([](Study& s) { s.simulation.noise_standard_deviation(0) = 0; }));
  CHECK(differs([](Study& s) { s.simulation.steps[0].level = 0; }));
  CHECK(differs([](Study& s) { s.mismatch.parameter_weight[2] = 0; }));
  CHECK(differs([](Study& s) { s.assessment.of<Badwe2009Options>().models.nf = 3; }));
}

TEST_CASE("what is not the default is named with it, and nothing else", "[resolved_study]") {
  const std::string small = small_study();
  const auto changes = [](const std::string& text) { return changed_defaults(parse_study(text, "s.toml")); };
  const std::vector<std::string> before = changes(small);
  CHECK(changes(small + "[diagnosis]\nmpm_threshold = 0.1\n") == before);  // written out, and the default
  std::vector<std::string> after =
      changes(small + "[diagnosis]\nmpm_threshold = 0.2\nself_check = \"none\"\n");
  const auto take = [&](const std::string& change) {
    const auto place = std::find(after.begin(), after.end(), change);
    REQUIRE(place != after.end());
    after.erase(place);
  };
  take("diagnosis.mpm_threshold = 0.2 (default: 0.1)");
  take("diagnosis.self_check = \"none\" (default: \"ivar\")");
  CHECK(after == before);
  Study other = parse_study(small, "s.toml");
  other.methods = {"sse"};
  CHECK(changed_defaults(other).back() == "methods.names = [\"sse\"] (default: [\"botelho\"])");
}

TEST_CASE("a dead time of 0 that is written out leaves a disturbance as it is", "[resolved_study]") {
  const std::string text = scenario_study_text();
  const std::string model = "gain = 0.1\ntime_constant = 0.3\n";
  const Study without = parse_study(text, "s.toml");
  const Study with = parse_study(replaced(text, model, model + "dead_time = 0\n"), "s.toml");
  CHECK(with.scenarios == without.scenarios);
}

}  // namespace
}  // namespace mpm
