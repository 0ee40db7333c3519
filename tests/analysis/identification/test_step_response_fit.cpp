#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/identification/step_test.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

using Catch::Contains;

Eigen::VectorXd response_of(const TransferFunction& channel, double sample_time, Eigen::Index samples) {
  return step_response(TransferMatrix{{channel}}, sample_time, samples).front().row(0).transpose();
}

/// Largest difference of the responses, relative to that of `channel`.
double difference(const TransferFunction& channel, const TransferFunction& found, double sample_time,
                  Eigen::Index samples) {
  const Eigen::VectorXd expected = response_of(channel, sample_time, samples);
  return (response_of(found, sample_time, samples) - expected).cwiseAbs().maxCoeff() /
         expected.cwiseAbs().maxCoeff();
}

TEST_CASE("a step response of a simple form gives its transfer function back", "[step-test]") {
  const double Ts = 4.0;
  const TransferFunction lag = TransferFunction::first_order(-4.05, 50.0, 27.0);  // 6.75 samples of dead time
  const StepResponseFit first = fit_step_response(response_of(lag, Ts, 100), Ts, 0.0);
  REQUIRE(first.channel.order() == 1);
  // The search stops when its steps no longer pay: far below 1e-6 of what it looks for.
  CHECK(first.channel.static_gain() == Approx(-4.05).epsilon(1e-6));
  CHECK(first.channel.residence_time() == Approx(50.0).epsilon(1e-6));
  CHECK(first.channel.dead_time() == Approx(27.0).epsilon(1e-6));
  CHECK(first.explained > 1.0 - 1e-10);
  CHECK(first.rms_error < 1e-6);

  for (const double damping : {0.3, 1.0, 3.0}) {
    const double tau = 20.0;
    const TransferFunction oscillation(Eigen::VectorXd::Constant(1, 2.0),
                                       Eigen::Vector3d(tau * tau, 2 * tau * damping, 1.0), 5.0);
    const StepResponseFit second = fit_step_response(response_of(oscillation, Ts, 100), Ts, 0.0);
    CHECK(second.channel.order() == 2);
    CHECK(second.channel.numerator().size() == 1);
    // Another pair of lag and dead time may do as well to within the negligible 1e-3 rms, a few times that at
    // its largest.
    CHECK(difference(oscillation, second.channel, Ts, 100) < 4e-3);
  }
  const TransferFunction inverse(Eigen::Vector2d(-30.0, 1.0), Eigen::Vector3d(400.0, 50.0, 1.0), 0.0);
  const StepResponseFit third = fit_step_response(response_of(inverse, Ts, 100), Ts, 0.0);
  CHECK(third.channel.numerator().size() == 2);
  CHECK(difference(inverse, third.channel, Ts, 100) < 4e-3);
}

TEST_CASE("noise neither makes a channel nor a richer form", "[step-test]") {
  RandomStream stream(3, 0, StreamId::measurement_noise);
  const double Ts = 2.0;
  Eigen::VectorXd noise(150);
  for (double& value : noise)
    value = 0.05 * stream.normal();
  CHECK(fit_step_response(noise, Ts, 0.0).channel.is_zero());
  const TransferFunction lag = TransferFunction::first_order(1.0, 30.0, 6.0);
  const StepResponseFit fit = fit_step_response(response_of(lag, Ts, 150) + noise, Ts, 0.0);
  CHECK(fit.channel.order() == 1);
  // 0.05/sqrt(150) = 0.004 is the error of a mean; the lag is known from 30 samples or so.
  CHECK(fit.channel.static_gain() == Approx(1.0).margin(0.03));
  CHECK(fit.channel.residence_time() == Approx(30.0).epsilon(0.2));
  CHECK(fit.rms_error == Approx(0.05).epsilon(0.2));
  CHECK(fit_step_response(Eigen::VectorXd::Zero(20), Ts, 0.0).channel.is_zero());
}

TEST_CASE("coefficients of a step response give the transfer function back exactly", "[step-test]") {
  const double interval = 2.0;
  for (const TransferFunction& channel :
       {TransferFunction::first_order(-4.05, 50.0, 27.0),
        TransferFunction(Eigen::VectorXd::Constant(1, 2.0), Eigen::Vector3d(400.0, 12.0, 1.0), 5.0),
        TransferFunction(Eigen::Vector2d(-30.0, 1.0), Eigen::Vector3d(400.0, 50.0, 1.0), 3.0)}) {
    const StepResponseFit fit = fit_step_coefficients(response_of(channel, interval, 150), interval);
    CHECK(fit.channel.numerator().size() == channel.numerator().size());
    CHECK(fit.largest_error < 1e-9);
    CHECK(difference(channel, fit.channel, interval, 150) < 1e-9);
  }
  Eigen::VectorXd rounded = response_of(TransferFunction::first_order(4.05, 50.0, 27.0), interval, 150);
  for (double& value : rounded)
    value = std::round(1e3 * value) / 1e3;
  CHECK(fit_step_coefficients(rounded, interval).largest_error < 5e-4 / 4.0 * 1.5);
  // Three equal lags are none of the forms. The fit says what it leaves.
  const TransferFunction third(Eigen::VectorXd::Ones(1), Eigen::Vector4d(8000.0, 1200.0, 60.0, 1.0), 0.0);
  const StepResponseFit fit = fit_step_coefficients(response_of(third, interval, 120), interval);
  CHECK(fit.largest_error == Approx(difference(third, fit.channel, interval, 120)).epsilon(1e-6));
  CHECK(fit.largest_error > 1e-3);
  CHECK(fit.largest_error < 0.02);
}

TEST_CASE("coefficients that have not settled are refused", "[step-test]") {
  const TransferFunction lag = TransferFunction::first_order(2.0, 50.0, 0.0);
  CHECK_THROWS_WITH(fit_step_coefficients(response_of(lag, 2.0, 40), 2.0),
                    Contains("goes to 2; allowed: coefficients until the response has settled"));
  CHECK_NOTHROW(fit_step_coefficients(response_of(lag, 2.0, 60), 2.0));
  const TransferFunction slow_flow(Eigen::VectorXd::Constant(1, 0.5), Eigen::Vector3d(40.0, 1.0, 0.0));
  CHECK_THROWS_WITH(fit_step_coefficients(response_of(slow_flow, 2.0, 40), 2.0),
                    Contains("at its end, where the fitted transfer function goes to 0.5"));
}

TEST_CASE("a settled response is none that is too short, wherever its fit goes", "[step-test]") {
  // Ten samples of an inverse response, a peak, and a tail: no form of two lags has it.
  Eigen::VectorXd odd(120);
  for (Eigen::Index k = 0; k < odd.size(); ++k) {
    const auto t = static_cast<double>(k + 1);
    odd(k) = 1 - std::exp(-t / 15) - 2 * std::exp(-std::pow((t - 5) / 3, 2)) +
             3 * std::exp(-std::pow((t - 30) / 4, 2));
  }
  CHECK_NOTHROW(fit_step_coefficients(odd, 2.0));
}

TEST_CASE("a channel keeps the coefficients that its fit does not give", "[step-test]") {
  const auto kept = [](const TransferFunction& channel, Eigen::Index count) {
    const Eigen::VectorXd values = response_of(channel, 2.0, count);
    const TransferFunction found = by_coefficients(fit_step_coefficients(values, 2.0), values, 2.0);
    CHECK((response_of(found, 2.0, count) - values).cwiseAbs().maxCoeff() <
          2e-9 * values.cwiseAbs().maxCoeff());
    return found.step_coefficients().has_value();
  };
  const TransferFunction lag = TransferFunction::first_order(-4.05, 20.0, 27.0);
  CHECK_FALSE(kept(lag, 300));
  CHECK(kept(lag, 60));  // after the last coefficient the transfer function rises on
  CHECK(kept({Eigen::VectorXd::Ones(1), Eigen::Vector4d(8000.0, 1200.0, 60.0, 1.0)}, 300));
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(20);
  CHECK(by_coefficients(fit_step_coefficients(none, 2.0), none, 2.0) == TransferFunction::zero());
}

TEST_CASE("a ramp is a channel that integrates", "[step-test]") {
  const StepResponseFit pure = fit_step_coefficients(Eigen::VectorXd::LinSpaced(60, 0.1, 6.0), 2.0);
  REQUIRE(pure.channel.is_integrating());
  CHECK(pure.channel.order() == 1);
  CHECK(pure.channel.rate_gain() == Approx(0.05).epsilon(1e-6));
  CHECK(pure.largest_error < 1e-6);
  for (const double dead_time : {0.0, 3.0, 7.3}) {
    const TransferFunction flow(Eigen::VectorXd::Constant(1, -0.3), Eigen::Vector3d(6.0, 1.0, 0.0),
                                dead_time);
    const StepResponseFit fit = fit_step_coefficients(response_of(flow, 2.0, 60), 2.0);
    REQUIRE(fit.channel.is_integrating());
    CHECK(fit.channel.rate_gain() == Approx(-0.3).epsilon(1e-5));
    CHECK(fit.channel.residence_time() == Approx(6.0).epsilon(1e-4));
    CHECK(fit.channel.dead_time() == Approx(dead_time).margin(1e-3));
    CHECK(difference(flow, fit.channel, 2.0, 60) < 1e-6);
  }
  // A slow lag is none, however little of it the response shows.
  const StepResponseFit slow =
      fit_step_response(response_of(TransferFunction::first_order(2.0, 100.0), 2.0, 60), 2.0, 0.0);
  CHECK_FALSE(slow.channel.is_integrating());
  CHECK(slow.channel.residence_time() == Approx(100.0).epsilon(1e-5));
}

TEST_CASE("bad step responses are refused", "[step-test]") {
  CHECK_THROWS_WITH(fit_step_response(Eigen::VectorXd::Ones(7), 1.0, 0.0),
                    Contains("found 7 samples; allowed: at"));
  CHECK_THROWS_WITH(fit_step_response(Eigen::VectorXd::Constant(9, NAN), 1.0, 0.0), Contains("not finite"));
  CHECK_THROWS_WITH(fit_step_response(Eigen::VectorXd::Ones(9), 0.0, 0.0), Contains("sample time: found 0"));
}

TEST_CASE("the step test of a linear plant is its step responses", "[step-test]") {
  const Study study = find_study("chapter6");
  const Eigen::Index inputs = study.mv_count() + study.md_count();
  const std::vector<StepResponse> found =
      step_test(study, {.sizes = Eigen::VectorXd::Constant(inputs, 0.1), .samples = 80});
  const std::vector<Eigen::MatrixXd> expected =
      step_response(study.plant.G, study.controller.sample_time, 80);
  REQUIRE(found.size() == expected.size());
  for (std::size_t j = 0; j < found.size(); ++j) {
    CHECK((found[j].response - expected[j]).cwiseAbs().maxCoeff() < 1e-12);  // rounding
    CHECK(found[j].asymmetry.maxCoeff() < 1e-12);
  }
  CHECK_THROWS_WITH(step_test(study, {.sizes = Eigen::VectorXd::Zero(inputs), .samples = 80}),
                    Contains("sizes of the steps"));
  const std::vector<StepResponse> noisy =
      step_test(study, {.sizes = Eigen::VectorXd::Constant(inputs, 0.1), .samples = 80, .noise = true});
  CHECK_FALSE(noisy[0].response.isApprox(found[0].response, 1e-6));
}

TEST_CASE("the step test of the nonlinear tank sees how it bends", "[step-test]") {
  const Study study = find_study("chapter5-tank");
  const auto asymmetry = [&](double size) {
    return step_test(study, {.sizes = Eigen::VectorXd::Constant(4, size), .samples = 60})[0].asymmetry(0);
  };
  // What is nonlinear is of second order in the step.
  CHECK(asymmetry(0.02) > 1e-4);
  CHECK(asymmetry(0.02) == Approx(0.1 * asymmetry(0.2)).epsilon(0.1));
}

}  // namespace
}  // namespace mpm
