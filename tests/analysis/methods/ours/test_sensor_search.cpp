#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "tests/solvers/active_set_factory.hpp"

// A sensor that is wrong is neither a mismatch nor a disturbance.

namespace mpm {
namespace {

ExperimentDraw draw_of_sensor(OtherFaultKind kind, Eigen::Index variable, double size) {
  ExperimentDraw draw;
  draw.kind = ExperimentKind::other;
  draw.index = 3;
  draw.onset.sample = 150;
  draw.other = OtherFault{kind, variable, size};
  return draw;
}

}  // namespace

TEST_CASE("the likelihood names a sensor that is wrong, of a CV and of an MD, and only such a one",
          "[sensor]") {
  Study study = find_study("wood-berry");
  study.assessment.model = AssessmentModel::benchmark;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"likelihood", "mpmbench"});
  const auto said = [&](const ExperimentDraw& draw) {
    return panel.assess(
        assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)), nullptr);
  };
  const double noise = study.simulation.noise_standard_deviation(0);
  REQUIRE(noise > 0.0);
  for (const ExperimentDraw& draw :
       {draw_of_sensor(OtherFaultKind::sensor_bias, 0, 15.0 * noise),
        draw_of_sensor(OtherFaultKind::sensor_drift, 1, -30.0 * noise),
        draw_of_sensor(OtherFaultKind::sensor_stuck, 0, kNaN),
        draw_of_sensor(OtherFaultKind::md_gain, 0, 0.4), draw_of_sensor(OtherFaultKind::md_noise, 0, 0.2)}) {
    INFO(to_string(draw.other->kind));
    const auto answers = said(draw);
    const AssessmentRecord& likelihood = answers.front();
    CHECK(likelihood.flagged);
    CHECK(likelihood.told() == ToldSource::sensor);
    CHECK(likelihood.number("p_other") > 0.7);
    CHECK(likelihood.number("p_sensor") > 0.9 * likelihood.number("p_other"));
    CHECK(std::isnan(likelihood.number("valve_mv")));
    if (const AssessmentRecord& mpmbench = answers.back(); mpmbench.flagged)
      CHECK(mpmbench.told() == ToldSource::sensor);
  }
  ExperimentDraw disturbance;
  disturbance.kind = ExperimentKind::ud;
  disturbance.index = 5;
  disturbance.disturbances = {{0, 0.5, 20.0}};
  CHECK(said(disturbance).front().told() == ToldSource::ud);
}

TEST_CASE("a ramp in one CV is its sensor's, one in several CVs a disturbance that reaches them",
          "[sensor]") {
  Study study = find_study("wood-berry");
  study.assessment.model = AssessmentModel::benchmark;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"likelihood"});
  ExperimentDraw healthy;
  healthy.index = 4;
  AssessedLoop loop =
      assessed_loop(study, basis.point, simulate_experiment(study, healthy, testing::kFactory));
  const auto add_ramp = [&](Eigen::Index cv) {
    const double noise = study.simulation.noise_standard_deviation(cv);
    loop.y.row(cv) += Eigen::RowVectorXd::LinSpaced(loop.samples(), -15.0, 25.0).cwiseMax(0.0) * noise;
  };
  add_ramp(0);
  CHECK(panel.assess(loop, nullptr).front().told() == ToldSource::sensor);
  add_ramp(1);
  CHECK(panel.assess(loop, nullptr).front().told() == ToldSource::ud);
}

}  // namespace mpm
