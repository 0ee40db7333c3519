#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/base/thorough.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Numbers that no plant has, in every series that a method can see, through every method that there is.

namespace mpm {
namespace {

/// Setpoints and an MD that move, and a signal that is logged: every method applies.
constexpr const char* kStudy = R"(
[study]
name = "unsound"
title = "unsound"
seed = 5
[plant]
name = "two"
title = "two by two"
time_unit = "min"
[[plant.cv]]
name = "y1"
unit = "1"
[[plant.cv]]
name = "y2"
unit = "1"
[[plant.mv]]
name = "u1"
unit = "1"
[[plant.mv]]
name = "u2"
unit = "1"
[[plant.md]]
name = "d1"
unit = "1"
[[plant.channel]]
cv = "y1"
input = "u1"
gain = 2.0
time_constant = 4.0
dead_time = 1.0
[[plant.channel]]
cv = "y2"
input = "u2"
gain = -1.0
time_constant = 3.0
[[plant.channel]]
cv = "y2"
input = "d1"
gain = 0.5
time_constant = 5.0
[controller]
sample_time = 1.0
prediction_horizon = 12
control_horizon = 3
[controller.mv.u1]
move_suppression = 1.0
hard = [-50.0, 50.0]
[controller.mv.u2]
move_suppression = 1.0
hard = [-50.0, 50.0]
[controller.cv.y1]
setpoint_weight = 1.0
hard = [-100.0, 100.0]
[controller.cv.y2]
setpoint_weight = 1.0
hard = [-100.0, 100.0]
[simulation]
samples = 160
noise_standard_deviation = 0.05
step = [
  {cv = "y1", sample = 20, level = 1.0}, {cv = "y1", sample = 60, level = -1.0},
  {cv = "y2", sample = 40, level = 1.0}, {cv = "y2", sample = 100, level = 0.0},
  {md = "d1", sample = 30, level = 1.0}, {md = "d1", sample = 90, level = -1.0},
]
[record]
candidates = {count = 2}
[experiments]
mpm = 1
ud = 1
mpm_ud = 0
[sensitivity]
samples = 40
[assessment.sun]
orders = [3]
[assessment.badwe2010]
smallest_order = 2
largest_order = 2
max_iterations = 3
[assessment.adequacy]
draws = 2
)";

/// One way to spoil a signal.
struct Spoiled {
  std::string name;
  AssessedLoop loop;
};

/// In each signal: one sample, one row and all of it, by each of these numbers.
std::vector<Spoiled> spoiled(const AssessedLoop& sound) {
  std::vector<Spoiled> all;
  for (const LoopSignal& signal : loop_signals())
    for (const double value : {kNaN, kInfinity, -kInfinity, 1e308, 1e100, 1e59, 1e-300, 1.0, 0.0})
      for (const char* where : {"a sample", "a row", "all", "every second sample"}) {
        Spoiled each{fmt::format("{} in {} of {}", value, where, signal.name), sound};
        Eigen::MatrixXd& series = each.loop.*signal.member;
        if (series.size() == 0)
          continue;
        const std::string place = where;
        if (place == "a sample")
          series(0, series.cols() / 3) = value;
        else if (place == "a row")
          series.row(0).setConstant(value);
        else if (place == "all")
          series.setConstant(value);
        else
          for (Eigen::Index k = 0; k < series.cols(); k += 2)
            series(0, k) = k % 4 == 0 ? value : -value;
        all.push_back(std::move(each));
      }
  return all;
}

struct Setting {
  explicit Setting(AssessmentModel model) : study(parse_study(kStudy, "unsound.toml")) {
    study.assessment.model = model;
    basis = run_basis_case(study, testing::kFactory);
    const ExperimentDraw draw = draw_experiment(study, 0);
    loop = assessed_loop(study, basis.point,
                         recorded(study, 0, simulate_experiment(study, draw, testing::kFactory)));
    loop.candidates = logged_candidates(study, draw);
  }

  AssessmentContext context(const AssessedLoop& benchmark) const {
    AssessmentContext made{study, basis, testing::kFactory, benchmark};
    learn_model(benchmark, made);
    return made;
  }
  AssessedLoop benchmark() const { return *assessment_context(study, basis, testing::kFactory).benchmark; }

  Study study;
  BasisCase basis;
  AssessedLoop loop;
};

/// A verdict has numbers, and what has none says why.
void check_answer(const Assessment& said) {
  if (said.status != AssessmentStatus::ok) {
    CHECK_FALSE(said.reason.empty());
    return;
  }
  CHECK_FALSE(std::isnan(said.score));
  for (const CvAssessment& cv : said.cvs)
    CHECK_FALSE((cv.flagged && std::isnan(cv.score)));
}

}  // namespace

TEST_CASE("every method answers a sound loop of the study of this test") {
  for (const AssessmentModel model : {AssessmentModel::nominal, AssessmentModel::benchmark}) {
    const Setting setting(model);
    const AssessmentContext context = setting.context(setting.benchmark());
    CHECK((context.correction != nullptr) == (model == AssessmentModel::benchmark));
    for (const std::string& name : shipped_methods().names()) {
      INFO(name);
      const Assessment said = Assessor(assessment_method(name), context).assess(setting.loop);
      INFO(said.reason);
      CHECK(said.status == AssessmentStatus::ok);
      check_answer(said);
    }
  }
}

TEST_CASE("no number in a loop makes a method crash, or answer without a number") {
  const Setting setting(AssessmentModel::nominal);
  const AssessmentContext context = setting.context(setting.benchmark());
  const AssessmentForms forms = assessment_forms(setting.study, shipped_methods().names());
  for (const auto& form : forms) {
    Assessor assessor(assessment_method(form->method().name), context);
    for (const Spoiled& each : spoiled(setting.loop)) {
      INFO(form->method().name << ": " << each.name);
      const Assessment said = assessor.assess(each.loop);
      INFO(said.reason);
      check_answer(said);
      CHECK(kept(form, said).answered() == (said.status == AssessmentStatus::ok));
    }
  }
}

TEST_CASE("no number in a benchmark makes a method crash, or answer without a number") {
  const Setting setting(AssessmentModel::benchmark);
  const std::size_t step = testing::is_thorough() ? 1 : 4;  // of the methods, another quarter in each case
  std::size_t number = 0;
  for (const Spoiled& each : spoiled(setting.benchmark())) {
    INFO(each.name);
    const AssessmentContext context = setting.context(each.loop);
    const std::vector<std::string> names = shipped_methods().names();
    for (std::size_t method = number++ % step; method < names.size(); method += step) {
      const std::string& name = names[method];
      INFO(name);
      Assessor assessor(assessment_method(name), context);
      check_answer(assessor.assess(setting.loop));
      check_answer(assessor.assess(setting.loop));  // a benchmark that taught nothing still teaches nothing
    }
  }
}

TEST_CASE("a value out of all proportion is named, in the loop and in the benchmark") {
  const Setting setting(AssessmentModel::nominal);
  AssessedLoop loop = setting.loop;
  loop.y(1, 7) = -1e160;
  const Assessment of_loop =
      Assessor(assessment_method("likelihood"), setting.context(setting.benchmark())).assess(loop);
  CHECK(of_loop.status == AssessmentStatus::failed);
  CHECK(of_loop.reason == "the loop has implausible values: y2 of -1e+160 at sample 7");
  const AssessmentContext context = setting.context(loop);
  const Assessment of_benchmark = Assessor(assessment_method("sse"), context).assess(setting.loop);
  CHECK(of_benchmark.status == AssessmentStatus::failed);
  CHECK(of_benchmark.reason == "the benchmark has implausible values: y2 of -1e+160 at sample 7");
}

/// Of a benchmark that shows no errors of the model.
class NoCorrection final : public ModelCorrection {
 public:
  std::shared_ptr<const AssessedLoop> corrected(const AssessedLoop&) const override {
    throw InputError("no likelihood");
  }
};

TEST_CASE("a benchmark whose errors of the model cannot be learnt fails the verdicts that need them") {
  const Setting setting(AssessmentModel::benchmark);
  AssessmentContext context = setting.context(setting.benchmark());
  context.correction = std::make_shared<const NoCorrection>();
  Assessor corrects(assessment_method("sse"), context), does_not(assessment_method("botelho"), context);
  for (int time = 0; time < 2; ++time) {
    const Assessment said = corrects.assess(setting.loop);
    CHECK(said.status == AssessmentStatus::failed);
    CHECK(said.reason == "no likelihood");
    CHECK(does_not.assess(setting.loop).status == AssessmentStatus::ok);
  }
}

TEST_CASE("the posterior of a noise needs no direction that explains a part of it") {
  const Eigen::RowVectorXd e = testing::white_noise(200, 3).transpose();
  const Eigen::MatrixXd none(0, 200), faint = Eigen::MatrixXd::Constant(1, 200, 1e-9);
  const NoisePosterior without = noise_posterior(e, none, 1e-6), with = noise_posterior(e, faint, 1e-6);
  CHECK(without.best.deviation == Approx(with.best.deviation));
  CHECK(without.log_evidence == Approx(with.log_evidence));
  CHECK_THROWS_AS(noise_posterior(Eigen::RowVectorXd::Constant(200, 1e200), none, 1e-6), InputError);
}

}  // namespace mpm
