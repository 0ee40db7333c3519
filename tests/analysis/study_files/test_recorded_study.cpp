#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/recorded_study.hpp"
#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/scenarios/study_texts.hpp"

// A record of the plant as a study of loops like it, and [data] of a study file.

namespace mpm {
namespace {

using namespace testing;

constexpr Eigen::Index kSamples = 80;

Study study_with(const std::string& data = "") {
  return parse_study(replaced(small_study(), "[controller.cv.level]\n",
                              "[controller.cv.level]\nsetpoint_weight = 4\nsetpoint = 0.1\n") +
                         data,
                     "s.toml");
}

/// A record of the small study in which everything moves.
PlantRecord moving_record() {
  PlantRecord record;
  record.y = Eigen::MatrixXd::Random(2, kSamples);
  record.u = Eigen::MatrixXd::Random(2, kSamples);
  record.d = Eigen::MatrixXd::Random(1, kSamples);
  record.u_target = Eigen::MatrixXd::Constant(2, kSamples, kNaN);
  record.y_set = record.lower = record.upper = record.y_sim = record.u_target;
  record.y_set.row(0).setConstant(0.3);
  record.y_set.row(0).tail(30).setConstant(0.4);
  record.upper.row(1).setConstant(0.5);
  record.upper.row(1).tail(20).setConstant(0.7);
  record.stamps.assign(kSamples, "");
  return record;
}

TEST_CASE("a recorded study has what moved the plant, to the last bit", "[recorded_study]") {
  const PlantRecord record = moving_record();
  const Study study = recorded_study(study_with(), record, {"order", "sse"}, MonitoringOptions{40, 10});
  CHECK(measured_disturbances(study) == record.d);
  CHECK(setpoints(study).row(0) == record.y_set.row(0));
  CHECK(soft_limits(study, 59).upper(1) == 0.5);
  CHECK(soft_limits(study, 60).upper(1) == 0.7);
  CHECK(soft_limits(study, 60).lower(1) == -kInfinity);
  CHECK(study.simulation.samples == kSamples);
  CHECK(study.methods == std::vector<std::string>{"order", "sse"});
  CHECK(study.monitoring == MonitoringOptions{40, 10});
  CHECK(study.seed == study_with().seed);
  CHECK(study.record.missing_share == 0.0);
}

TEST_CASE("a recorded study has off what operators had taken, MVs where they put them", "[recorded_study]") {
  PlantRecord record = moving_record();
  record.u.row(0).segment(10, 4).setConstant(0.25);
  record.u_off.setZero(2, kSamples);
  record.u_off.row(0).segment(10, 5).setOnes();
  record.u_off(0, kSamples - 1) = 1.0;
  record.y_off.setZero(2, kSamples);
  record.y_off.row(1).segment(0, 30).setOnes();
  const Study study = recorded_study(study_with(), record, {"order"}, {});
  const std::vector<OffSpell> expected{{VariableSort::cv, 1, 0, 30, {}},
                                       {VariableSort::mv, 0, 10, 4, 0.25},
                                       {VariableSort::mv, 0, 14, 1, record.u(0, 14)},
                                       {VariableSort::mv, 0, kSamples - 1, 1, record.u(0, kSamples - 1)}};
  CHECK(study.simulation.off == expected);
  CHECK(trial_study(study, {.healthy = 2, .faulty = 2}).simulation.off == expected);
}

TEST_CASE("a recorded study misses as many samples as the record, in gaps as long", "[recorded_study]") {
  PlantRecord record = moving_record();
  record.y.row(0).segment(10, 6).setConstant(kNaN);
  record.y.row(1).segment(0, 2).setConstant(kNaN);
  const Study study = recorded_study(study_with("[record]\ncompression = 1\nmissing = {share = 0.3}\n"),
                                     record, {"order"}, {});
  CHECK(study.record.missing_share == Approx(8.0 / 160.0).epsilon(1e-12));  // a quotient, rounded once
  CHECK(study.record.missing_length == 4.0);
  CHECK(study.record.fill == GapFill::none);
  CHECK(study.record.compression == 1.0);
  CHECK_FALSE(study.monitoring);
}

TEST_CASE("without moves of its signals a recorded study has no excitation", "[recorded_study]") {
  PlantRecord record = moving_record();
  record.d.setZero();
  record.y_set.row(0).setConstant(0.3);
  record.upper.setConstant(kNaN);
  CHECK_FALSE(recorded_study(study_with(), record, {"order"}, {}).simulation.is_excited());
}

TEST_CASE("a trial study draws the faults of the study under another seed", "[recorded_study]") {
  const Study recorded = recorded_study(study_with(), moving_record(), {"order"}, MonitoringOptions{40, 10});
  const Study trial =
      trial_study(recorded, {.healthy = 7, .faulty = 12});  // the small study has 3, 2 and 1 of 6
  CHECK(trial.experiments == ExperimentCounts{.mpm = 6, .ud = 4, .mpm_ud = 2, .healthy = 7});
  CHECK(trial.seed == (recorded.seed ^ kCalibrationBits));
  CHECK(trial.seed <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  CHECK(trial.mismatch == recorded.mismatch);
  CHECK(measured_disturbances(trial) == measured_disturbances(recorded));
  CHECK_FALSE(trial.monitoring);
  CHECK(is_trial_study(trial));
  CHECK_FALSE(is_trial_study(recorded));
}

TEST_CASE("a recorded study that cannot be is refused", "[recorded_study]") {
  PlantRecord record = moving_record();
  record.upper.row(1).tail(20).setConstant(7.0);  // the hard limit is 3
  CHECK_THROWS_WITH(recorded_study(study_with(), record, {"order"}, {}),
                    Catch::Contains("limit_step[0].soft: found [-inf, 7]") && Catch::Contains("hard ones"));
  PlantRecord brief = moving_record();
  brief.y = brief.y.leftCols(30).eval();
  CHECK_THROWS_WITH(recorded_study(study_with(), brief, {"order"}, {}),
                    "record: found 30 samples of the controller; allowed: 60 and more, of 1 s each: a longer "
                    "period");
}

TEST_CASE("what [data] cannot say is refused", "[recorded_study]") {
  check_refusals({
      {"", "[data]\ntags = {leve = 'a'}\n", "tags",
       "data.tags: found unknown key 'leve' (nearest: 'level'); allowed: level, heat, hot, cold, drain"},
      {"", "[data]\nscale = {level = 0}\n", "scale",
       "data.scale: found level = 0; allowed: factors that are not 0"},
      {"", "[data]\nperiod = ['1']\n", "period",
       "data.period: found another number of time stamps; allowed: two, the first and the last"},
      {"", "[data]\ndecimal = ';'\n", "decimal", "data.decimal: found ';'; allowed: ., ,"},
      {"", "[data]\nmost_missing = 1.5\n", "most_missing",
       "data.most_missing: found 1.5; allowed: a number in (0, 1)"},
  });
}

}  // namespace
}  // namespace mpm
