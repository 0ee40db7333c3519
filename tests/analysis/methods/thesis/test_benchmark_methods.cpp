#include <cmath>
#include <optional>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/analysis/signals.hpp"

// The methods that compare a loop with a benchmark period, through the interface that all methods share.

using mpm::AssessedLoop;
using mpm::Assessment;
using mpm::assessment_method;
using mpm::AssessmentStatus;
using mpm::Study;

namespace {

constexpr double kNone = mpm::kNaN;

/// White control errors of 3 CVs about setpoints that step, and simulation errors of a tenth of that size.
AssessedLoop made_up_loop(Eigen::Index samples, std::uint64_t number) {
  AssessedLoop loop;
  loop.y_set = Eigen::MatrixXd::Zero(3, samples);
  loop.y_set.rightCols(samples / 2).setConstant(5.0);
  loop.y = loop.y_set + mpm::testing::white_noise(3 * samples, number).reshaped(3, samples);
  loop.y_sim = loop.y + 0.1 * mpm::testing::white_noise(3 * samples, number + 100).reshaped(3, samples);
  loop.u = loop.u_target = Eigen::MatrixXd::Zero(3, samples);
  loop.d.resize(0, samples);
  return loop;
}

class Setting {
 public:
  explicit Setting(std::optional<AssessedLoop> benchmark) : benchmark_(std::move(benchmark)) {}

  Assessment assess(const char* method, const AssessedLoop& loop) const {
    const mpm::AssessmentContext context{study, basis_, mpm::qp_solver_factory("active-set"), benchmark_};
    return mpm::Assessor(assessment_method(method), context).assess(loop);
  }

  void set(const char* key, const char* value) {
    study = mpm::changed_study(study, {{key, value}}, "the test");
  }

  Study study = mpm::find_study("chapter2-shell");

 private:
  mpm::BasisCase basis_;
  std::optional<AssessedLoop> benchmark_;
};

/// The same where variances are taken about the setpoints, which that study does about the means.
Setting about_setpoints(const AssessedLoop& benchmark) {
  Setting setting(benchmark);
  setting.study.diagnosis.variance_centre = mpm::VarianceCentre::setpoint;
  return setting;
}

}  // namespace

TEST_CASE("yu-qin: the CV that varies more is named, the one that varies less is not") {
  const AssessedLoop benchmark = made_up_loop(400, 1);
  AssessedLoop loop = benchmark;
  loop.y.row(1) = loop.y_set.row(1) + 3.0 * (loop.y - loop.y_set).row(1);
  loop.y.row(2) = loop.y_set.row(2) + 0.3 * (loop.y - loop.y_set).row(2);
  const Assessment found = Setting(benchmark).assess("yu-qin", loop);
  REQUIRE(found.status == AssessmentStatus::ok);
  CHECK(found.flagged);
  CHECK(found.score > 1.0);
  CHECK(found.number("i_v") == Approx(0.81));
  CHECK(found.worst_cv() == 1);
  CHECK(found.cvs[1].flagged == true);
  CHECK(found.cvs[2].flagged == false);
  CHECK(found.number("worse", 1) == 1.0);
  CHECK(found.number("better", 2) == 1.0);
  CHECK(found.number("worse", 2) == 0.0);
  CHECK(found.number("cos_worse", 1) > found.number("beta"));

  const Assessment same = Setting(benchmark).assess("yu-qin", benchmark);
  CHECK_FALSE(same.flagged);
  CHECK(same.number("i_v") == Approx(1.0));
}

TEST_CASE(
    "variance-ratio: the variance over that of the benchmark, about setpoints, against the band of impact") {
  const AssessedLoop benchmark = made_up_loop(400, 1);
  AssessedLoop loop = benchmark;
  loop.y.row(1) = loop.y_set.row(1) + 2.0 * (loop.y - loop.y_set).row(1);
  loop.y.row(2) = loop.y_set.row(2) + 0.95 * (loop.y - loop.y_set).row(2);
  loop.y_sim.setZero();  // it knows no model
  const Assessment found = about_setpoints(benchmark).assess("variance-ratio", loop);
  REQUIRE(found.status == AssessmentStatus::ok);
  CHECK(found.flagged);
  CHECK(found.number("ratio", 0) == 1.0);
  CHECK(found.number("ratio", 1) == Approx(4.0));
  CHECK(found.number("ratio", 2) == Approx(0.9025));  // within 0.8 to 1.2
  CHECK(found.score == Approx(3.0));
  CHECK(found.worst_cv() == 1);
  CHECK(found.cvs[1].flagged == true);
  CHECK(found.cvs[2].flagged == false);

  // Another size of the steps under the same errors is no change; less variance than the band has is one.
  AssessedLoop moved = benchmark;
  moved.y.array() += 7.0;
  moved.y_set.array() += 7.0;
  CHECK_FALSE(about_setpoints(benchmark).assess("variance-ratio", moved).flagged);
  AssessedLoop calm = benchmark;
  calm.y.row(0) = calm.y_set.row(0) + 0.8 * (calm.y - calm.y_set).row(0);
  CHECK(about_setpoints(benchmark).assess("variance-ratio", calm).flagged);

  // A gap is closed along a straight line; a CV that stands still in both is passed over.
  AssessedLoop gaps = benchmark;
  gaps.y(0, 17) = kNone;
  CHECK_FALSE(about_setpoints(benchmark).assess("variance-ratio", gaps).flagged);
  AssessedLoop still = benchmark;
  still.y.row(0) = still.y_set.row(0);
  const Assessment passed_over = about_setpoints(still).assess("variance-ratio", still);
  CHECK_FALSE(passed_over.flagged);
  CHECK_FALSE(passed_over.cvs[0].flagged.has_value());
  CHECK(passed_over.score == 0.0);
}

TEST_CASE("yu-qin:largest-root: the method with the limits of the largest root") {
  const AssessedLoop benchmark = made_up_loop(400, 1);
  AssessedLoop loop = made_up_loop(400, 2);
  loop.y.row(1) = loop.y_set.row(1) + 1.5 * (loop.y - loop.y_set).row(1);
  Setting setting(benchmark);
  const Assessment published = setting.assess("yu-qin", loop);
  const Assessment repaired = setting.assess("yu-qin:largest-root", loop);
  CHECK(repaired.flagged);
  CHECK(repaired.worst_cv() == 1);
  CHECK(repaired.number("mu_max") == published.number("mu_max"));
  CHECK(repaired.score < published.score);
  setting.set("assessment.yu-qin.limits", "\"largest-root\"");
  CHECK(setting.assess("yu-qin", loop).score == repaired.score);
}

TEST_CASE("yu-qin: when every direction is worse, the CV of the worst comes first") {
  const AssessedLoop benchmark = made_up_loop(400, 9);
  AssessedLoop loop = benchmark;
  loop.y = loop.y_set + Eigen::Vector3d(2.0, 4.0, 3.0).asDiagonal() * (loop.y - loop.y_set);
  const Assessment found = Setting(benchmark).assess("yu-qin", loop);
  for (Eigen::Index cv = 0; cv < 3; ++cv) {
    CHECK(found.number("cos_worse", cv) == Approx(1.0));
    CHECK(found.cvs[static_cast<std::size_t>(cv)].flagged == true);
  }
  CHECK(found.worst_cv() == 1);
}

TEST_CASE("yu-qin: nothing is said of a CV without a setpoint, in the loop or in the benchmark") {
  AssessedLoop benchmark = made_up_loop(400, 2);
  AssessedLoop loop = benchmark;
  loop.y.row(1) = 3.0 * loop.y.row(1);
  loop.y_set.row(1).setConstant(kNone);
  const Assessment found = Setting(benchmark).assess("yu-qin", loop);
  REQUIRE(found.status == AssessmentStatus::ok);
  CHECK_FALSE(found.flagged);
  CHECK_FALSE(found.cvs[1].flagged.has_value());
  CHECK(std::isnan(found.cvs[1].score));
  CHECK(std::isnan(found.number("worse", 1)));
  CHECK(found.cvs[0].flagged == false);

  benchmark.y_set.row(0).setConstant(kNone);
  benchmark.y_set.row(2).setConstant(kNone);
  const Assessment none = Setting(benchmark).assess("yu-qin", loop);
  CHECK(none.status == AssessmentStatus::not_applicable);
  CHECK(none.reason.find("no CV has a setpoint in this loop and in the benchmark") != std::string::npos);
}

TEST_CASE("yu-qin: what it needs, and a benchmark that gives no answer") {
  const AssessedLoop loop = made_up_loop(100, 3);
  CHECK(Setting(std::nullopt).assess("yu-qin", loop).status == AssessmentStatus::not_applicable);
  AssessedLoop ranges = loop;
  ranges.y_set.setConstant(kNone);
  CHECK(Setting(loop).assess("yu-qin", ranges).reason.find("setpoints") != std::string::npos);
  AssessedLoop still = loop;
  still.y.row(0) = still.y_set.row(0);
  const Assessment found = Setting(still).assess("yu-qin", loop);
  CHECK(found.status == AssessmentStatus::failed);
  CHECK(found.reason.find("linearly dependent") != std::string::npos);
}

TEST_CASE("yu-qin: first_sample leaves out how a loop starts") {
  const AssessedLoop benchmark = made_up_loop(400, 4);
  AssessedLoop loop = benchmark;
  loop.y.row(0).head(50).array() += 20.0;
  Setting setting(benchmark);
  CHECK(setting.assess("yu-qin", loop).flagged);
  setting.set("assessment.yu-qin.first_sample", "50");
  const Assessment found = setting.assess("yu-qin", loop);
  CHECK_FALSE(found.flagged);
  CHECK(found.number("i_v") == Approx(1.0));
  CHECK(setting.assess("yu-qin", made_up_loop(51, 5)).status == AssessmentStatus::not_applicable);
  setting.set("assessment.yu-qin.first_sample", "399");
  CHECK(setting.assess("yu-qin", loop).status == AssessmentStatus::not_applicable);
}

TEST_CASE("sse: mean squares over those of the benchmark, whatever the lengths") {
  const AssessedLoop benchmark = made_up_loop(400, 6);
  AssessedLoop loop = made_up_loop(4000, 7);
  const Eigen::MatrixXd error = loop.y_sim - loop.y;
  loop.y_sim.row(2) = loop.y.row(2) + 2.0 * error.row(2);
  const Assessment found = Setting(benchmark).assess("sse", loop);
  REQUIRE(found.status == AssessmentStatus::ok);
  CHECK(found.number("sse", 2) == Approx(2.0 * error.row(2).norm()));
  CHECK(found.number("tsse") ==
        Approx(error.row(0).norm() + error.row(1).norm() + 2.0 * error.row(2).norm()));
  // Mean squares of 400 values scatter by sqrt(2/400) = 0.07; 4 of that.
  CHECK(found.number("ratio", 0) == Approx(1.0).margin(0.3));
  CHECK(found.number("ratio", 2) == Approx(4.0).margin(1.2));
  CHECK(found.cvs[2].flagged == true);
  CHECK(found.cvs[0].flagged == false);
  CHECK(found.flagged);
  CHECK(found.score == found.number("ratio", 2));
}

TEST_CASE("sse: threshold, exact models, and no benchmark") {
  const AssessedLoop benchmark = made_up_loop(400, 8);
  AssessedLoop loop = benchmark;
  loop.y_sim = loop.y + 1.3 * (loop.y_sim - loop.y);  // 1.69 times the mean square
  Setting setting(benchmark);
  CHECK(setting.assess("sse", loop).flagged);
  setting.set("assessment.sse.threshold", "1.7");
  CHECK_FALSE(setting.assess("sse", loop).flagged);
  AssessedLoop exact = benchmark;
  exact.y_sim = exact.y;
  CHECK(std::isinf(Setting(exact).assess("sse", loop).score));
  const Assessment perfect = Setting(exact).assess("sse", exact);
  CHECK_FALSE(perfect.flagged);
  CHECK(perfect.cvs[0].score == 1.0);  // the same errors
  AssessedLoop rounded = exact;        // one unit in the last place of some 5, which is no error of a model
  rounded.y_sim.array() += 8.9e-16;
  CHECK(Setting(exact).assess("sse", rounded).score == 1.0);
  CHECK(Setting(rounded).assess("sse", exact).score == 1.0);
  CHECK(Setting(std::nullopt).assess("sse", loop).status == AssessmentStatus::not_applicable);
}
