#include <variant>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

constexpr const char* kCounts = "[experiments]\nmpm = 3\nud = 2\nmpm_ud = 1\n";

/// The small study with these scenarios in place of its counts.
std::string named_text(const std::string& scenarios) {
  return replaced(small_study(), kCounts, scenarios);
}

Study named(const std::string& scenarios) {
  return parse_study(named_text(scenarios), "s.toml");
}

const std::string kAll =
    "[[scenario]]\nname = 'healthy'\n"
    "[[scenario]]\nname = 'mpm'\ndescription = 'two channels'\n"
    "mismatch = [{cv = 'level', input = 'hot', gain_factor = 1.5, dead_time_shift = -1},\n"
    "            {cv = 'level', input = 'drain', time_constant_factor = 2}]\n"
    "[[scenario]]\nname = 'both'\naffected = ['heat']\n"
    "mismatch = [{cv = 'heat', input = 'hot', gain = 3, time_constant = 4, dead_time = 5}]\n"
    "disturbance = [{cv = 'level', gain = 0.5, time_constant = 6}, {cv = 'heat', white = 2, hold = 3}]\n"
    "[[scenario]]\nname = 'signals'\naffected = []\n"
    "disturbance = [{cv = 'level', sine = {amplitude = 0.2, period = 30}},\n"
    "               {cv = 'level', ramp = {slope = 0.01, start = 7}, numerator = [1], denominator = [2, "
    "0]},\n"
    "               {cv = 'heat', steps = [{sample = 3, level = 1}, {sample = 9, level = -1}], gain = -2, "
    "time_constant = 8}]\n";

TEST_CASE("every key of a scenario lands in its place", "[scenario]") {
  const Study study = named(kAll);
  REQUIRE(study.names_scenarios());
  REQUIRE(study.experiment_count() == 4);
  CHECK(study.experiments.total() == 0);
  CHECK(study.scenarios[0].description.empty());
  const Scenario& mpm = study.scenarios[1];
  CHECK(mpm.name == "mpm");
  CHECK(mpm.description == "two channels");
  REQUIRE(mpm.mismatches.size() == 3);  // a channel with two changes has two mismatches
  CHECK(mpm.mismatches[0].parameter == MismatchParameter::gain);
  CHECK(mpm.mismatches[0].value == 1.5);
  CHECK(mpm.mismatches[1].parameter == MismatchParameter::dead_time);
  CHECK(mpm.mismatches[1].value == -1);
  CHECK(mpm.mismatches[2].input == 2);  // the MD stands after the MVs
  CHECK(mpm.mismatches[2].value == 2);
  CHECK_FALSE(mpm.affected_cvs.has_value());

  const Scenario& both = study.scenarios[2];
  REQUIRE(both.mismatches.size() == 1);
  CHECK(both.mismatches[0].parameter == MismatchParameter::channel);
  REQUIRE(both.mismatches[0].channel.has_value());
  CHECK(both.mismatches[0].channel->static_gain() == 3);
  CHECK(both.mismatches[0].channel->dead_time() == 5);
  REQUIRE(both.disturbances.size() == 2);
  CHECK(both.disturbances[0].model == DisturbanceModel::first_order);
  CHECK(both.disturbances[0].gain == 0.5);
  CHECK(both.disturbances[0].time_constant == 6);
  CHECK(std::get<WhiteNoise>(both.disturbances[0].signal).factor == 1);
  CHECK(both.disturbances[1].model == DisturbanceModel::direct);
  CHECK(std::get<WhiteNoise>(both.disturbances[1].signal).factor == 2);
  CHECK(std::get<WhiteNoise>(both.disturbances[1].signal).hold == 3);
  CHECK(both.affected_cvs == std::vector<Eigen::Index>{1});

  const Scenario& signals = study.scenarios[3];
  REQUIRE(signals.disturbances.size() == 3);
  CHECK(std::get<Sine>(signals.disturbances[0].signal).period == 30);
  CHECK(std::get<Ramp>(signals.disturbances[1].signal).start == 7);
  CHECK(signals.disturbances[1].model == DisturbanceModel::transfer_function);
  CHECK(signals.disturbances[1].Gd->is_integrating());
  REQUIRE(std::get<StepSequence>(signals.disturbances[2].signal).steps.size() == 2);
  CHECK(std::get<StepSequence>(signals.disturbances[2].signal).steps[1].level == -1);
  CHECK(signals.disturbances[2].gain == -2);
  CHECK(signals.affected_cvs == std::vector<Eigen::Index>{});
}

TEST_CASE("experiment i of a study of named scenarios is scenario i", "[scenario]") {
  const Study study = named(kAll);
  const ExperimentDraw healthy = draw_experiment(study, 0);
  CHECK(healthy.named);
  CHECK(healthy.kind == ExperimentKind::healthy);
  CHECK(healthy.affected().empty());
  CHECK(healthy.true_cv() == -1);
  CHECK(draw_experiment(study, 1).kind == ExperimentKind::mpm);
  CHECK(draw_experiment(study, 1).true_cv() == 0);
  CHECK(draw_experiment(study, 2).kind == ExperimentKind::mpm_ud);
  CHECK(draw_experiment(study, 3).kind == ExperimentKind::ud);
  CHECK(draw_experiment(study, 3).index == 3);
  CHECK_THROWS_WITH(draw_experiment(study, 4),
                    "experiment index: found 4; allowed: 0 to 3, the named scenarios of the study");
}

TEST_CASE("the truth of a scenario: CVs with a fault, unless the study says otherwise", "[scenario]") {
  const std::string faults =
      "mismatch = [{cv = 'heat', input = 'cold', gain_factor = 2}]\n"
      "disturbance = [{cv = 'heat', white = 1}, {cv = 'level', white = 1}]\n";
  const Study study = named("[[scenario]]\nname = 'a'\n" + faults + "[[scenario]]\nname = 'b'\n" + faults +
                            "affected = ['level']\n"
                            "[[scenario]]\nname = 'c'\naffected = ['level']\n"
                            "disturbance = [{cv = 'heat', white = 1}]\n");
  const std::vector<AffectedCv> a = draw_experiment(study, 0).affected();
  REQUIRE(a.size() == 2);
  CHECK((a[0].cv == 0 && a[0].by == FaultSource::ud));
  CHECK((a[1].cv == 1 && a[1].by == FaultSource::mpm_ud));
  CHECK(draw_experiment(study, 0).true_cv() == -1);
  const std::vector<AffectedCv> b = draw_experiment(study, 1).affected();
  REQUIRE(b.size() == 1);
  CHECK((b[0].cv == 0 && b[0].by == FaultSource::ud));
  const std::vector<AffectedCv> c = draw_experiment(study, 2).affected();  // no fault of its own
  REQUIRE(c.size() == 1);
  CHECK((c[0].cv == 0 && c[0].by == FaultSource::ud));

  const ExperimentDraw both = draw_experiment(study, 0);
  CHECK(both.mismatch_alone().kind == ExperimentKind::mpm);
  CHECK(both.mismatch_alone().disturbances.empty());
  CHECK(both.disturbance_alone().kind == ExperimentKind::ud);
  CHECK(both.disturbance_alone().mismatches.empty());
}

/// The message for a study with one scenario "a" that has these lines.
std::string refused(const std::string& lines) {
  const std::string message = refusal(named_text("[[scenario]]\nname = 'a'\n" + lines));
  const std::string front = "s.toml:";
  REQUIRE(message.starts_with(front));
  return message.substr(message.find(' ') + 1);
}

TEST_CASE("a study has counts or scenarios", "[scenario]") {
  const std::string text = small_study() + "[[scenario]]\nname = 'a'\n";
  CHECK(refusal(text).ends_with(
      "experiments: found random experiments beside named scenarios; allowed: one of the two"));
  CHECK(refusal(named_text("[mismatch]\ngain_factor = {constant = 2}\n[[scenario]]\nname = 'a'\n"))
            .ends_with("mismatch: found random experiments beside named scenarios; allowed: one of the two"));
  CHECK(refusal(named_text("")).ends_with("experiments: found nothing; allowed: a table"));
  CHECK(refusal(named_text("[[scenario]]\nname = 'a'\n[[scenario]]\nname = 'a'\n"))
            .ends_with("scenario[1].name: found 'a' for a second scenario; allowed: every name once"));
}

TEST_CASE("mismatches that are none are refused", "[scenario]") {
  CHECK(refused("mismatch = [{cv = 'level', input = 'hot'}]\n") ==
        "scenario[0].mismatch[0]: found no mismatch; allowed: either gain_factor, time_constant_factor and "
        "dead_time_shift, or a transfer function");
  CHECK(
      refused("mismatch = [{cv = 'level', input = 'hot', gain_factor = 2, gain = 3, time_constant = 4}]\n") ==
      "scenario[0].mismatch[0]: found changes of the channel beside another channel; allowed: either "
      "gain_factor, time_constant_factor and dead_time_shift, or a transfer function");
  CHECK(refused("mismatch = [{cv = 'level', input = 'cold', gain_factor = 2}]\n") ==
        "scenario[0].mismatch[0].input: found a channel that is zero in the model; allowed: a transfer "
        "function in its place");
  CHECK(refused("mismatch = [{cv = 'level', input = 'hot', gain_factor = 0}]\n") ==
        "scenario[0].mismatch[0].gain_factor: found 0; allowed: a number > 0");
  CHECK(refused("mismatch = [{cv = 'level', input = 'hot', dead_time_shift = -4}]\n") ==
        "scenario[0].mismatch[0]: dead time after a shift: found 3 + -4 = -1; allowed: a finite number >= 0");
  CHECK(refused(
            "mismatch = [{cv = 'level', input = 'hot', dead_time = 20000, gain = 1, time_constant = 1}]\n") ==
        "scenario[0].mismatch[0]: found a dead time of 20000; allowed: at most 10000 samples");
  CHECK(
      refused("mismatch = [{cv = 'level', input = 'hot', numerator = [1], denominator = [1, 0]}]\n") ==
      "scenario[0].mismatch[0].denominator: found a pole with real part 0; allowed: poles with negative real "
      "parts, since the model of this CV has no pole at 0");
  CHECK(refused("mismatch = [{cv = 'level', input = 'hot', gain_factor = 2}, {cv = 'level', input = 'hot', "
                "dead_time_shift = 1}]\n") ==
        "scenario[0].mismatch[1]: found a second mismatch of this channel; allowed: every channel once");
  CHECK(refused("mismatch = [{cv = 'level', input = 'warm', gain_factor = 2}]\n") ==
        "scenario[0].mismatch[0].input: found 'warm'; allowed: hot, cold, drain");
  CHECK(refused("mismatch = []\n") ==
        "scenario[0].mismatch: found a list of 0; allowed: a list of tables, one or more");
}

TEST_CASE("disturbances that are none are refused", "[scenario]") {
  const auto of = [](const std::string& keys) {
    return refused("disturbance = [{cv = 'heat'" + keys + "}]\n");
  };
  const std::string at = "scenario[0].disturbance[0]";
  CHECK(of("") == at + ": found neither a signal nor a transfer function; allowed: at least one of the two");
  CHECK(of(", white = 1, sine = {amplitude = 1, period = 2}") ==
        at + ".sine: found sine beside white; allowed: one signal a disturbance");
  CHECK(of(", ramp = {slope = 1}, hold = 2") == at +
                                                    ".hold: found hold beside ramp; allowed: hold of a white "
                                                    "signal");
  CHECK(of(", white = 0") == at + ".white: found 0; allowed: a number > 0");
  CHECK(of(", white = 1, hold = 61") == at + ".hold: found 61; allowed: a whole number from 1 to 60");
  CHECK(of(", sine = {amplitude = 1, period = 0}") == at + ".sine.period: found 0; allowed: a number > 0");
  CHECK(of(", ramp = {start = 0}") == at + ".ramp.slope: found nothing; allowed: a finite number");
  CHECK(of(", steps = [{sample = 5, level = 1}, {sample = 5, level = 2}]") ==
        at + ".steps[1].sample: found 5; allowed: a whole number from 6 to 59");
  CHECK(of(", gain = 1") == at + ".time_constant: found nothing; allowed: a number > 0");
  CHECK(of(", numerator = [1], denominator = [1, -1]") ==
        at + ".denominator: found a pole with real part 1; allowed: poles with negative real parts, or at 0");
  CHECK(of(", numerator = [1, 1], denominator = [1]") ==
        at + ": numerator degree of a transfer function: found 1; allowed: at most the denominator degree 0");
  CHECK(of(", gain = 1, time_constant = 1, dead_time = 1e6") ==
        at + ".dead_time: found 1000000; allowed: at most 10000 samples");
}

TEST_CASE("a truth that cannot be is refused", "[scenario]") {
  CHECK(refused("affected = ['heat']\n") ==
        "scenario[0].affected: found a list of 1 in a scenario without fault; allowed: an empty list");
  CHECK(refused("affected = ['warm']\n") == "scenario[0].affected: found 'warm'; allowed: level, heat");
  CHECK(refused("affected = 'heat'\n") ==
        "scenario[0].affected: found 'heat'; allowed: a list of one or more of level, heat");
}

}  // namespace
}  // namespace mpm
