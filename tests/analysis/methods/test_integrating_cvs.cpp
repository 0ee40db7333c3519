#include <cmath>
#include <optional>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

// CVs that integrate, as T0 and the methods see them.

namespace mpm {
namespace {

constexpr double kRate = 0.5, kSample = 2.0, kWeight = 4, kSuppression = 3;

TransferMatrix level_with(double rate) {
  return {{TransferFunction(Eigen::VectorXd::Constant(1, rate), Eigen::Vector2d(1, 0))}};
}

/// A level at a setpoint, one step ahead: with g = K Ts the law is u += q g (r - y - g u) / (q g^2 + s).
Study level_study() {
  Study study;
  study.plant = {.name = "level",
                 .title = "",
                 .time_unit = "min",
                 .cvs = {{"L", "m", ""}},
                 .mvs = {{"F", "m3/h", ""}},
                 .mds = {},
                 .G = level_with(kRate)};
  MpcOptions& options = study.controller;
  options.sample_time = kSample;
  options.prediction_horizon = options.control_horizon = 1;
  options.move_suppression = Eigen::VectorXd::Constant(1, kSuppression);
  options.setpoint_weight = Eigen::VectorXd::Constant(1, kWeight);
  options.target_weight = options.slack_weight = options.mv_cost = Eigen::VectorXd::Zero(1);
  options.mv_hard = options.cv_hard = options.cv_soft = Limits::none(1);
  study.simulation.initial_setpoint = Eigen::VectorXd::Zero(1);
  study.simulation.noise_standard_deviation = Eigen::VectorXd::Constant(1, 0.1);
  study.assessment.washout = 30.0;
  study.sensitivity.samples = 60;
  return study;
}

/// y(k+1) and u(k) from y(k) and u(k-1) without reference, as a matrix.
Eigen::Matrix2d closed_loop_matrix() {
  constexpr double g = kRate * kSample, c = kWeight * g / (kWeight * g * g + kSuppression);
  return (Eigen::Matrix2d() << 1 - g * c, g * (1 - g * c), -c, 1 - g * c).finished();
}

Trajectory loop_of(const Study& study, const TransferMatrix& plant, const Eigen::MatrixXd& noise) {
  return run_closed_loop(study, plant,
                         {.d = Eigen::MatrixXd(0, noise.cols()),
                          .noise = noise,
                          .y_d = Eigen::MatrixXd::Zero(1, noise.cols()),
                          .y_set = {},
                          .dither = {}},
                         testing::kFactory);
}

}  // namespace

TEST_CASE("T0 of a level is that of its difference equation", "[integrating]") {
  const Study study = level_study();
  const NominalSensitivity t0 =
      nominal_sensitivity(study, operating_point(study, testing::kFactory), testing::kFactory);
  REQUIRE(t0.step_response.size() == 1);
  // From the setpoint 1: its deviation from 1 goes by the closed-loop matrix from (-1, 0).
  Eigen::Vector2d deviation(-1, 0);
  for (Eigen::Index l = 0; l < 60; ++l) {
    deviation = closed_loop_matrix() * deviation;
    CHECK(t0.step_response[0](0, l) == Approx(1 + deviation(0)).margin(1e-7));
  }
}

TEST_CASE("a level under noise has the variance of the Lyapunov equation", "[integrating]") {
  Study study = level_study();
  constexpr Eigen::Index kSamples = 40000;
  study.simulation.samples = kSamples;
  const Trajectory loop = loop_of(study, study.plant.G, measurement_noise(study, 1));
  REQUIRE(loop.status == ControlStatus::ok);
  // x = (y without noise, u(k-1)); the noise v of y acts through the law alone: P = A P A' + B B' var v.
  const Eigen::Matrix2d A = closed_loop_matrix();
  constexpr double g = kRate * kSample, c = kWeight * g / (kWeight * g * g + kSuppression), v = 0.1 * 0.1;
  const Eigen::Vector2d B(-g * c, -c);
  Eigen::Matrix2d P = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2000; ++i)
    P = A * P * A.transpose() + v * B * B.transpose();
  const double expected = P(0, 0) + v;
  // Of 40000 samples that are alike over a few: 1 %; three of them.
  CHECK(loop.y.row(0).squaredNorm() / kSamples == Approx(expected).epsilon(0.03));
}

TEST_CASE("what drifts in y_sim stays in place behind the washout", "[integrating]") {
  const Study study = level_study();
  constexpr Eigen::Index kSamples = 400;
  Trajectory loop;
  loop.u = loop.u_target = Eigen::MatrixXd::Constant(1, kSamples, 0.2);
  loop.d = Eigen::MatrixXd(0, kSamples);
  loop.y_set = Eigen::MatrixXd::Zero(1, kSamples);
  loop.y = Eigen::MatrixXd(1, kSamples);
  constexpr double kFactor = 1.1, kBias = 5.0;
  for (Eigen::Index k = 0; k < kSamples; ++k)
    loop.y(0, k) = kBias + kFactor * kRate * kSample * 0.2 * static_cast<double>(k);
  const OperatingPoint point{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1), {}, {}};
  const AssessedLoop seen = assessed_loop(study, point, loop);
  // e = 5 + 0.02 k: behind the washout 0.02/(1 - a) in the end, whatever the constant.
  const double a = std::exp(-kSample / 30.0);
  const Eigen::RowVectorXd e = seen.y.row(0) - seen.y_sim.row(0);
  CHECK(e(kSamples - 1) == Approx(0.02 / (1 - a)).epsilon(1e-8));
  CHECK(std::abs(e(0)) < 0.1);
  // And back: what is left is the record less its start.
  const Eigen::MatrixXd back = from_washout(study, seen.y);
  const Eigen::RowVectorXd moved = (loop.y.row(0).array() - loop.y(0, 0)).matrix();
  CHECK((back.row(0) - moved)
            .array()
            .isApprox(Eigen::ArrayXd::Constant(kSamples, (back(0, 0) - moved(0))).transpose(), 1e-9));
}

TEST_CASE("an exact model leaves the noise of a level, with and without gaps", "[integrating]") {
  Study study = find_study("suite-evaporator");
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.samples = 200;
  const OperatingPoint point = operating_point(study, testing::kFactory);
  Trajectory loop = simulate_experiment(study, {}, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  AssessedLoop seen = assessed_loop(study, point, loop);
  CHECK((seen.y - seen.y_sim).cwiseAbs().maxCoeff() < 1e-10);
  loop.y.row(0).segment(50, 20).setConstant(kNaN);
  seen = assessed_loop(study, point, loop);
  CHECK(seen.y.row(0).segment(50, 20).array().isNaN().all());
  CHECK((seen.y - seen.y_sim).array().isNaN().select(0.0, seen.y - seen.y_sim).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("an exact model of coefficients leaves nothing either, and its error what it does",
          "[integrating]") {
  Study study = find_study("suite-evaporator");
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input)
      if (TransferFunction& channel = study.plant.G(cv, input); !channel.is_zero())
        channel = channel.with_step_coefficients(
            step_response(TransferMatrix{{channel}}, study.controller.sample_time, 40)
                .front()
                .row(0)
                .transpose(),
            study.controller.sample_time);
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.samples = 200;
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory loop = simulate_experiment(study, {}, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  const AssessedLoop seen = assessed_loop(study, point, loop);
  CHECK((seen.y - seen.y_sim).cwiseAbs().maxCoeff() < 1e-10);  // as above
  // A channel's response by its discrete equivalent is that of the plant, from a steady input on as well.
  const double Ts = study.controller.sample_time;
  for (const TransferFunction& channel : {study.plant.G(1, 0), study.assessed_channel(0, 0)}) {
    const Eigen::RowVectorXd u = loop.u.row(0);
    LinearPlant plant(TransferMatrix{{channel}}, Ts);
    plant.reset(u.head(1));
    const Eigen::RowVectorXd found = channel_response(discretise(channel, Ts), u, u(0));
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      REQUIRE(found(k) == Approx(plant.output()(0)).margin(1e-10));  // roundings of 40 coefficients
      plant.advance(u.col(k));
    }
  }
}

TEST_CASE("methods tell a healthy level from a wrong one", "[integrating]") {
  Study study = find_study("suite-evaporator");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK(basis.healthy);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory),
                    {"botelho", "order", "likelihood", "mpmbench", "counterfactual"});
  const auto said = [&](const ExperimentDraw& draw) {
    return panel.assess(
        assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)), nullptr);
  };
  ExperimentDraw healthy;
  healthy.kind = ExperimentKind::healthy;
  healthy.index = 5;
  for (const AssessmentRecord& answer : said(healthy))
    CHECK_FALSE(answer.flagged);
  ExperimentDraw leak = healthy;
  leak.kind = ExperimentKind::mpm;
  leak.mismatches = {{0, 0, MismatchParameter::gain, 0.6}};  // the product flow empties the tank more slowly
  for (const AssessmentRecord& answer : said(leak)) {
    INFO(answer.form->method().name);
    CHECK(answer.flagged);
  }
}

}  // namespace mpm
