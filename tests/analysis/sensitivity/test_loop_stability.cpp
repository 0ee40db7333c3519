// Whether loops are stable: against what long loops do.

#include <cmath>
#include <tuple>

#include <catch2/catch.hpp>

#include "analysis/sensitivity/loop_stability.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/controller/controller_program.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

using testing::kFactory;

/// A setpoint MPC without limits: one law at every sample.
Study stable_study() {
  Study study = find_study("chapter4-shell");
  study.controller.mv_hard = Limits::none(study.mv_count());
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.setpoint_steps = {{0, 0, 0.01}};
  return study;
}

ExperimentDraw with_mismatch(const Mismatch& mismatch) {
  ExperimentDraw draw;
  draw.kind = ExperimentKind::mpm;
  draw.mismatches = {mismatch};
  return draw;
}

/// The factor by which the loop grows in a sample, from how large it is at the ends of the second half of its
/// record. Over windows that hold some periods, so that their phases do not matter.
double growth_of(const Study& study, const ExperimentDraw& draw) {
  const Trajectory loop = run_closed_loop(study, with_mismatches(study.plant.G, draw.mismatches),
                                          experiment_signals(study, draw), kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  // The differences, in which what has settled is gone.
  const Eigen::Index N = loop.y.cols(), window = N / 8;
  const Eigen::MatrixXd change = loop.y.rightCols(N - 1) - loop.y.leftCols(N - 1);
  const double early = change.middleCols(N / 2, window).norm(), late = change.rightCols(window).norm();
  return std::pow(late / early, 1.0 / static_cast<double>(N - 1 - window - N / 2));
}

double radius_of(const Study& study, const ExperimentDraw& draw) {
  return LoopStability(study, operating_point(study, kFactory)).spectral_radius(draw);
}

TEST_CASE("stability: a loop that rings grows by its spectral radius in a sample", "[loop_stability]") {
  Study study = stable_study();
  study.simulation.samples = 600;
  for (const auto& [cv, mv, factor] :
       {std::tuple{2, 2, 2.6}, std::tuple{2, 2, 3.5}, std::tuple{0, 0, -1.0}}) {
    const ExperimentDraw draw = with_mismatch({cv, mv, MismatchParameter::gain, factor});
    const double radius = radius_of(study, draw);
    INFO("gain of y" << cv + 1 << "-u" << mv + 1 << " times " << factor << ": " << radius);
    CHECK(radius > 1.0);
    // What else is in the loop decays against the mode that grows; 0.1 % of the rate in 300 samples.
    CHECK(growth_of(study, draw) == Approx(radius).epsilon(1e-3));
  }
}

TEST_CASE("stability: a loop that decays does so by its spectral radius", "[loop_stability]") {
  Study study = stable_study();
  study.simulation.samples = 600;
  const ExperimentDraw draw = with_mismatch({1, 1, MismatchParameter::gain, 0.8});
  const double radius = radius_of(study, draw);
  CHECK(radius < 1.0);
  CHECK(growth_of(study, draw) == Approx(radius).epsilon(5e-3));
}

TEST_CASE("stability: dead times of part of a sample, and longer ones than the model's", "[loop_stability]") {
  Study study = stable_study();
  study.simulation.samples = 600;
  for (const auto& [cv, mv, shift] : {std::tuple{2, 2, 6.5}, std::tuple{0, 0, 5.3}}) {
    const ExperimentDraw draw = with_mismatch({cv, mv, MismatchParameter::dead_time, shift});
    const double radius = radius_of(study, draw);
    INFO("dead time of y" << cv + 1 << "-u" << mv + 1 << " " << shift << " longer: " << radius);
    CHECK(radius > 1.0);
    CHECK(growth_of(study, draw) == Approx(radius).epsilon(1e-3));
  }
}

TEST_CASE("stability: of the plant alone, whatever disturbs it; not of another loop", "[loop_stability]") {
  const Study study = find_study("chapter6");
  const LoopStability stability(study, operating_point(study, kFactory));
  ExperimentDraw disturbed;
  disturbed.disturbances = {{0, 1.0, 30.0}};
  const double nominal = stability.spectral_radius(basis_draw());
  CHECK(nominal < 1.0);
  CHECK(stability.spectral_radius(disturbed) == nominal);
  CHECK(stability.spectral_radius(study.plant.G) == nominal);
  // y3 is inside its range: no move looks at it.
  CHECK(stability.spectral_radius(with_mismatch({2, 0, MismatchParameter::gain, 1.4})) == nominal);
  CHECK(stability.spectral_radius(with_mismatch({0, 0, MismatchParameter::gain, 1.4})) != nominal);
  ExperimentDraw held;
  held.other = OtherFault{OtherFaultKind::held_mv, 0, kNaN};
  CHECK(std::isnan(stability.spectral_radius(held)));
}

TEST_CASE("stability: of step coefficients it is that of their transfer function", "[loop_stability]") {
  const Study study = stable_study();
  Study stepped = study;
  stepped.plant.G(0, 0) =
      study.plant.G(0, 0).with_step_coefficients(Eigen::VectorXd::LinSpaced(30, 0.1, 9.0), 4.0);
  const ExperimentDraw draw = with_mismatch({0, 0, MismatchParameter::gain, -1.0});
  CHECK(radius_of(stepped, draw) == radius_of(study, draw));
}

TEST_CASE("stability: not known of a program, and of one slack for all samples", "[loop_stability]") {
  Study study = find_study("chapter6");
  const OperatingPoint point = operating_point(study, kFactory);
  study.controller.slack_form = SlackForm::per_cv;
  CHECK(std::isnan(LoopStability(study, point).spectral_radius(basis_draw())));
  study.controller.slack_form = SlackForm::per_sample;
  OperatingPoint fewer = point;
  fewer.active.pop_back();  // two CVs do not determine three targets
  CHECK(std::isnan(LoopStability(study, fewer).spectral_radius(basis_draw())));
  study.controller_program = ControllerProgram({"true"}, 1.0);
  CHECK(std::isnan(LoopStability(study, point).spectral_radius(basis_draw())));
}

}  // namespace
}  // namespace mpm
