#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/in_series.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "tests/plants/plant_samples.hpp"

// Channels by the coefficients of their step responses.

namespace mpm {
namespace {

using Catch::Contains;
using samples::polynomial;

Eigen::VectorXd coefficients_of(const TransferFunction& channel, double interval, Eigen::Index count) {
  return step_response(TransferMatrix{{channel}}, interval, count).front().row(0).transpose();
}

/// The channel by `count` of its own coefficients.
TransferFunction by_own_coefficients(const TransferFunction& channel, double interval, Eigen::Index count) {
  return channel.with_step_coefficients(coefficients_of(channel, interval, count), interval);
}

Eigen::RowVectorXd response_to(const TransferFunction& channel, double sample_time,
                               const Eigen::RowVectorXd& input) {
  return simulate(TransferMatrix{{channel}}, sample_time, input);
}

double largest(const Eigen::RowVectorXd& row) {
  return row.cwiseAbs().maxCoeff();
}

TransferFunction flow_with_lag() {
  return {polynomial({0.3}), polynomial({6, 1, 0}), 3.3};
}

/// No transfer function at all.
Eigen::VectorXd rough_coefficients(Eigen::Index count) {
  return samples::rough_input(1, count).row(0).transpose();
}

TransferFunction rough_channel(Eigen::Index count, double interval, bool ramps) {
  const TransferFunction parameters = ramps ? TransferFunction(polynomial({1}), polynomial({4, 1, 0}), 5)
                                            : TransferFunction::first_order(1, 4, 5);
  return parameters.with_step_coefficients(rough_coefficients(count), interval);
}

}  // namespace

TEST_CASE("coefficients of a transfer function respond to any held input as it does", "[step_coefficients]") {
  const double Ts = 2;
  const Eigen::RowVectorXd u = samples::rough_input(1, 900);
  for (const TransferFunction& channel :
       {TransferFunction::first_order(3, 7, 0), TransferFunction::first_order(-4.05, 20, 13.1),
        TransferFunction(polynomial({2}), polynomial({60, 17, 1}), 4),
        TransferFunction(polynomial({-9, 1}), polynomial({100, 12, 1}), 0), flow_with_lag(),
        TransferFunction(polynomial({0.05}), polynomial({1, 0}), 0)}) {
    const Eigen::RowVectorXd expected = response_to(channel, Ts, u);
    // 400 coefficients reach over 40 of the slowest time constants, e^-40 = 4e-18. What is left are roundings
    // of sums of 400 numbers.
    CHECK(largest(response_to(by_own_coefficients(channel, Ts, 400), Ts, u) - expected) <
          1e-9 * largest(expected));
    // At other samples too where these are multiples of the interval.
    CHECK(largest(response_to(by_own_coefficients(channel, Ts, 400), 3 * Ts, u) -
                  response_to(channel, 3 * Ts, u)) < 1e-9 * largest(response_to(channel, 3 * Ts, u)));
  }
}

TEST_CASE("any coefficients respond as dynamic matrix control sums them up", "[step_coefficients]") {
  for (const Eigen::Index n : {2, 3, 40, 1000}) {
    const Eigen::RowVectorXd u = samples::rough_input(1, 2 * n + 7);
    const Eigen::VectorXd a = rough_coefficients(n);
    for (const bool ramps : {false, true}) {
      const Eigen::RowVectorXd y = response_to(rough_channel(n, 2, ramps), 2, u);
      const double slope = ramps ? a(n - 1) - a(n - 2) : 0.0;
      for (Eigen::Index k = 0; k < y.size(); ++k) {
        double expected = 0;
        for (Eigen::Index i = 1; i <= k; ++i)  // the move i samples ago
          expected += (u(k - i) - (k > i ? u(k - i - 1) : 0.0)) *
                      (i <= n ? a(i - 1) : a(n - 1) + static_cast<double>(i - n) * slope);
        // Roundings of some thousand terms of the order of the response.
        REQUIRE(y(k) == Approx(expected).margin(1e-11 * static_cast<double>(n)));
      }
    }
  }
}

TEST_CASE("a channel of coefficients starts in its steady state", "[step_coefficients]") {
  const Eigen::VectorXd u = Eigen::VectorXd::Constant(1, 1.7);
  const double of_ramp = 2 / (1 - std::exp(-2.0 / 9));  // what the filter of samples makes of a rate of 1
  const TransferFunction steady = rough_channel(30, 2, false), ramp = rough_channel(30, 2, true);
  LinearPlant plant(TransferMatrix{{steady}, {ramp}, {steady.behind_washout(9)}, {ramp.behind_washout(9)}},
                    2);
  plant.advance(Eigen::VectorXd::Constant(1, -3));
  plant.reset(u);
  for (int k = 0; k < 80; ++k) {
    // Roundings of 30 sums, and of a ramp of 80 samples.
    CHECK(plant.output()(0) == Approx(steady.static_gain() * 1.7).epsilon(1e-13));
    CHECK(plant.output()(1) == Approx(ramp.rate_gain() * 2 * k * 1.7).margin(1e-12));
    CHECK(plant.output()(2) == Approx(0).margin(1e-13));
    CHECK(plant.output()(3) == Approx(ramp.rate_gain() * of_ramp * 1.7).epsilon(1e-13));
    plant.advance(u);
  }
}

TEST_CASE("between coefficients the response is a straight line", "[step_coefficients]") {
  const double K = 3, tau = 7, T = 2;
  const TransferFunction lag = TransferFunction::first_order(K, tau);
  const TransferFunction found = by_own_coefficients(lag, T, 200);
  const Eigen::VectorXd exact = coefficients_of(lag, T / 4, 800);
  const Eigen::VectorXd lines = coefficients_of(found, T / 4, 800);
  const double off = (lines - exact).cwiseAbs().maxCoeff();
  CHECK(off < T * T / 8 * K / (tau * tau));  // of |S''| <= K / tau^2
  CHECK(off > 0.7 * T * T / 8 * K / (tau * tau));
  for (Eigen::Index k = 3; k < 800; k += 4)
    CHECK(lines(k) == Approx(exact(k)).epsilon(1e-12));  // on the coefficients
}

TEST_CASE("mismatches of a channel move its coefficients", "[step_coefficients]") {
  const double T = 2;
  const Eigen::RowVectorXd u = samples::rough_input(1, 300);
  for (const TransferFunction& channel : {TransferFunction::first_order(3, 9, 6),
                                          TransferFunction(polynomial({0.3}), polynomial({6, 1, 0}), 6)}) {
    const TransferFunction found = by_own_coefficients(channel, T, 200);
    const auto differ = [&](const TransferFunction& a, const TransferFunction& b) {
      return largest(response_to(a, T, u) - response_to(b, T, u)) / largest(response_to(b, T, u));
    };
    // Rounding: coefficients of whole samples stay coefficients.
    CHECK(differ(found.with_gain_scaled(-1.3), channel.with_gain_scaled(-1.3)) < 1e-11);
    CHECK(differ(found.with_dead_time_shifted(2 * T), channel.with_dead_time_shifted(2 * T)) < 1e-11);
    CHECK(differ(found.with_dead_time_shifted(-3 * T), channel.with_dead_time_shifted(-3 * T)) < 1e-11);
    CHECK(differ(found.with_time_scaled(0.5), channel.with_time_scaled(0.5)) < 1e-11);
    // New samples lie on lines that are off by T^2 / 8 of the curvature, 1 / 9^2 or 1 / 6^2 of the response.
    CHECK(differ(found.with_time_scaled(1.3), channel.with_time_scaled(1.3)) < 0.02);
    CHECK(differ(found.with_dead_time_shifted(0.7), channel.with_dead_time_shifted(0.7)) < 0.02);
    CHECK(found.with_time_scaled(1.3).residence_time() == channel.with_time_scaled(1.3).residence_time());
    CHECK(found.with_dead_time_shifted(0.7).dead_time() == 6.7);
    CHECK(found.has_time_constant());
    // Changes of changes are those at once.
    CHECK(differ(found.with_time_scaled(2).with_dead_time_shifted(3).with_time_scaled(0.5),
                 found.with_dead_time_shifted(3)) < 1e-11);
  }
}

TEST_CASE("a further lag behind coefficients is exact for straight lines", "[step_coefficients]") {
  // Halving the interval leaves a quarter of the error.
  const TransferFunction lag = TransferFunction::first_order(3, 9, 4),
                         slow = TransferFunction::first_order(1, 5, 1);
  const TransferFunction both = in_series(lag, slow);
  double error[2];
  for (const int finer : {1, 2}) {
    const double T = 2.0 / finer;
    const TransferFunction found = in_series(by_own_coefficients(lag, T, 200 * finer), slow);
    CHECK(found.static_gain() == Approx(3).epsilon(1e-8));  // it settles to 1e-9
    CHECK(found == in_series(slow, by_own_coefficients(lag, T, 200 * finer)));
    error[finer - 1] = (coefficients_of(found, 2, 150) - coefficients_of(both, 2, 150)).cwiseAbs().maxCoeff();
  }
  CHECK(error[0] < 2 * 2 / 8.0 * 3 / 81);
  CHECK(error[1] == Approx(error[0] / 4).epsilon(0.15));
  const TransferFunction ramp = in_series(by_own_coefficients(flow_with_lag(), 2, 100), slow);
  CHECK(ramp.rate_gain() == Approx(0.3).epsilon(1e-8));
}

TEST_CASE("a washout of coefficients is that of the samples", "[step_coefficients]") {
  const double Ts = 2, washout = 30, a = std::exp(-Ts / washout);
  const Eigen::RowVectorXd u = samples::rough_input(1, 400);
  for (const bool ramps : {false, true})
    for (const double interval : {2.0, 3.1}) {
      const TransferFunction channel = rough_channel(50, interval, ramps).with_dead_time_shifted(1.5);
      const Eigen::RowVectorXd y = response_to(channel, Ts, u);
      Eigen::RowVectorXd expected(y.size());
      double mean = 0;
      for (Eigen::Index k = 0; k < y.size(); ++k) {
        expected(k) = y(k) - mean;
        mean = a * mean + (1 - a) * y(k);
      }
      // Roundings of y, which a ramp makes a hundred times larger than what is left of it.
      CHECK(largest(response_to(channel.behind_washout(washout), Ts, u) - expected) < 1e-11);
      CHECK(channel.behind_washout(washout).without_washout() == channel);
      CHECK(channel.behind_washout(washout).with_gain_scaled(2) ==
            channel.with_gain_scaled(2).behind_washout(washout));
    }
}

TEST_CASE("gains of a channel are those of its coefficients", "[step_coefficients]") {
  const TransferFunction lag = TransferFunction::first_order(3, 9, 6);
  const Eigen::VectorXd short_ones = coefficients_of(lag, 2, 20);
  const TransferFunction found = lag.with_step_coefficients(short_ones, 2);
  CHECK(found.static_gain() == short_ones(19));  // not yet 3
  CHECK(found.memory() == 40);
  CHECK(found.rate_gain() == 0);
  CHECK(by_own_coefficients(flow_with_lag(), 2, 100).rate_gain() == Approx(0.3).epsilon(1e-12));
  CHECK_FALSE(found == lag);
  CHECK(found == lag.with_step_coefficients(short_ones, 2));
  CHECK(found.without_step_coefficients() == lag);
  // A pulse that comes back has no static gain and an effect all the same.
  CHECK_FALSE(TransferFunction::zero().with_step_coefficients(polynomial({1, 2, 1, 0}), 1).is_zero());
}

TEST_CASE("bad step coefficients are refused", "[step_coefficients]") {
  const TransferFunction lag = TransferFunction::first_order(3, 9, 6);
  CHECK_THROWS_WITH(
      lag.with_step_coefficients(Eigen::VectorXd::Ones(1), 2),
      Contains("coefficients of a step response: found 1; allowed: two or more finite numbers"));
  CHECK_THROWS_WITH(lag.with_step_coefficients(Eigen::VectorXd::Constant(3, kNaN), 2),
                    Contains("not finite"));
  for (const double interval : {0.0, -1.0, kInfinity})
    CHECK_THROWS_WITH(lag.with_step_coefficients(Eigen::VectorXd::Ones(3), interval),
                      Contains("time between two coefficients"));
  CHECK_THROWS_WITH(discretise(lag.with_step_coefficients(Eigen::VectorXd::Ones(3), 1e7), 1),
                    Contains("at most 1000000"));
}

}  // namespace mpm
