
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/in_series.hpp"
#include "plants/linear/transfer_function.hpp"
#include "tests/plants/plant_samples.hpp"

namespace mpm {
namespace {

using Complex = std::complex<double>;
using samples::polynomial;

// A handful of roundings of numbers of order one.
constexpr double kResponseRounding = 1e-13;

const std::vector<Complex> kPoints = {{0, 0.01}, {0, 1.3}, {0.2, -0.7}, {0.05, 0}};

}  // namespace

TEST_CASE("a first-order transfer function has its defining values", "[transfer_function]") {
  const TransferFunction G = TransferFunction::first_order(4.05, 50, 27);
  CHECK(G.static_gain() == 4.05);
  CHECK(G.dead_time() == 27);
  CHECK(G.order() == 1);
  CHECK_FALSE(G.is_zero());
  CHECK_FALSE(G.is_integrating());
  for (const Complex s : kPoints) {
    const Complex expected = 4.05 * std::exp(-27.0 * s) / (50.0 * s + 1.0);
    CHECK(std::abs(G(s) - expected) < kResponseRounding * std::abs(expected));
  }
}

TEST_CASE("coefficients stand in descending powers of s", "[transfer_function]") {
  const TransferFunction G(polynomial({-3, 2}), polynomial({5, 4, 1}));
  for (const Complex s : kPoints) {
    const Complex expected = (-3.0 * s + 2.0) / (5.0 * s * s + 4.0 * s + 1.0);
    CHECK(std::abs(G(s) - expected) < kResponseRounding);
  }
  CHECK(G.static_gain() == 2);
}

TEST_CASE("the zero transfer function", "[transfer_function]") {
  CHECK(TransferFunction::zero().is_zero());
  CHECK(TransferFunction::zero().static_gain() == 0);
  CHECK(TransferFunction::zero()(Complex(0, 1)) == 0.0);
  const TransferFunction dead_integrator(polynomial({0, 0}), polynomial({1, 0}));
  CHECK(dead_integrator.is_zero());
  CHECK_FALSE(dead_integrator.is_integrating());
  CHECK(dead_integrator.static_gain() == 0);
}

TEST_CASE("leading zeros of the numerator and common factors s are removed", "[transfer_function]") {
  const TransferFunction padded(polynomial({0, 0, 2}), polynomial({3, 1}));
  CHECK(padded.numerator() == polynomial({2}));
  CHECK(padded.denominator() == polynomial({3, 1}));

  const TransferFunction cancelled(polynomial({2, 0, 0}), polynomial({3, 1, 0}));
  CHECK(cancelled.numerator() == polynomial({2, 0}));
  CHECK(cancelled.denominator() == polynomial({3, 1}));
  CHECK(cancelled.static_gain() == 0);
}

TEST_CASE("an integrating channel has no static gain", "[transfer_function]") {
  const TransferFunction G(polynomial({2}), polynomial({3, 1, 0}));
  CHECK(G.is_integrating());
  CHECK_THROWS_AS(G.static_gain(), InputError);
  CHECK(G.rate_gain() == 2);
  CHECK(TransferFunction::first_order(2, 5).rate_gain() == 0);
}

TEST_CASE("the lag of an integrating channel changes without its rate", "[transfer_function]") {
  const TransferFunction G(polynomial({2}), polynomial({3, 1, 0}), 4);
  CHECK(G.residence_time() == 3);
  CHECK(G.has_time_constant());
  const TransferFunction slow = G.with_time_scaled(2.5);
  CHECK(slow.rate_gain() == 2);
  CHECK(slow.residence_time() == 7.5);
  CHECK(slow.dead_time() == 4);
  const TransferFunction pure(polynomial({2}), polynomial({1, 0}));
  CHECK_FALSE(pure.has_time_constant());
  for (const Complex s : kPoints)
    CHECK(std::abs(pure.with_time_scaled(2.5)(s) - pure(s)) < 1e-14);
}

TEST_CASE("a washout takes the pole at the origin, and changes of the channel pass through it",
          "[transfer_function]") {
  const TransferFunction G(polynomial({2}), polynomial({3, 1, 0}), 4);
  const TransferFunction washed = G.behind_washout(20);
  CHECK(washed.washout() == 20);
  CHECK(washed.static_gain() == Approx(2 * 20));
  CHECK(washed.residence_time() == 3);
  for (const Complex s : kPoints)
    CHECK(std::abs(washed(s) - G(s) * 20.0 * s / (20.0 * s + 1.0)) < 1e-13);
  CHECK(washed.with_gain_scaled(1.3) == G.with_gain_scaled(1.3).behind_washout(20));
  CHECK(washed.with_time_scaled(0.7) == G.with_time_scaled(0.7).behind_washout(20));
  CHECK(washed.with_dead_time_shifted(-1) == G.with_dead_time_shifted(-1).behind_washout(20));
  const TransferFunction lag = TransferFunction::first_order(1, 2);
  CHECK(in_series(washed, lag) == in_series(G, lag).behind_washout(20));
  CHECK_FALSE(washed == G);
  CHECK_THROWS_AS(G.behind_washout(0), InputError);
}

TEST_CASE("mismatch functions change one property and nothing else", "[transfer_function]") {
  for (const TransferFunction& G : samples::every_kind()) {
    const double theta = G.dead_time();
    const TransferFunction gain = G.with_gain_scaled(-1.7);
    const TransferFunction slow = G.with_time_scaled(2.5);
    const double rate = G.is_integrating() ? 2.5 : 1.0;  // whose gain stays
    const TransferFunction late = G.with_dead_time_shifted(0.75);
    for (const Complex s : kPoints) {
      const Complex rational_at_scaled = G(2.5 * s) * std::exp(2.5 * s * theta);
      // Relative to |e^{...}|, up to e^{4} here: a few roundings.
      CHECK(std::abs(gain(s) - -1.7 * G(s)) < 1e-12);
      CHECK(std::abs(slow(s) - rate * rational_at_scaled * std::exp(-s * theta)) < 1e-12);
      CHECK(std::abs(late(s) - G(s) * std::exp(-0.75 * s)) < 1e-12);
    }
    CHECK(slow.dead_time() == theta);
    CHECK(slow.static_gain() == G.static_gain());
    CHECK(late.static_gain() == G.static_gain());
  }
}

TEST_CASE("mismatch functions at their neutral and limiting values", "[transfer_function]") {
  const TransferFunction G = TransferFunction::first_order(2, 5, 3);
  CHECK(G.with_time_scaled(1).denominator() == G.denominator());
  CHECK(G.with_gain_scaled(0).is_zero());
  CHECK(G.with_dead_time_shifted(-3).dead_time() == 0);
  CHECK(G.with_time_scaled(1.3).denominator() == polynomial({6.5, 1}));
}

TEST_CASE("bad transfer functions are refused", "[transfer_function]") {
  const Eigen::VectorXd one = polynomial({1});
  const Eigen::VectorXd lag = polynomial({2, 1});
  CHECK_THROWS_AS(TransferFunction(Eigen::VectorXd(), lag), InputError);
  CHECK_THROWS_AS(TransferFunction(one, Eigen::VectorXd()), InputError);
  CHECK_THROWS_AS(TransferFunction(polynomial({kNaN}), lag), InputError);
  CHECK_THROWS_AS(TransferFunction(one, polynomial({1, kInfinity})), InputError);
  CHECK_THROWS_AS(TransferFunction(one, polynomial({0, 1})), InputError);
  CHECK_THROWS_AS(TransferFunction(one, polynomial({0})), InputError);
  CHECK_THROWS_AS(TransferFunction(polynomial({1, 0, 0}), lag), InputError);
  CHECK_THROWS_AS(TransferFunction(one, lag, -0.1), InputError);
  CHECK_THROWS_AS(TransferFunction(one, lag, kNaN), InputError);
  CHECK_THROWS_AS(TransferFunction(one, lag, kInfinity), InputError);
  CHECK_THROWS_AS(TransferFunction::first_order(1, 0), InputError);
  CHECK_THROWS_AS(TransferFunction::first_order(1, -2), InputError);
  CHECK_THROWS_AS(TransferFunction::first_order(1, kNaN), InputError);
  CHECK_THROWS_AS(TransferFunction::first_order(kNaN, 1), InputError);
}

TEST_CASE("bad mismatch parameters are refused", "[transfer_function]") {
  const TransferFunction G = TransferFunction::first_order(2, 5, 3);
  CHECK_THROWS_AS(G.with_gain_scaled(kNaN), InputError);
  CHECK_THROWS_AS(G.with_gain_scaled(kInfinity), InputError);
  CHECK_THROWS_AS(G.with_time_scaled(0), InputError);
  CHECK_THROWS_AS(G.with_time_scaled(-1), InputError);
  CHECK_THROWS_AS(G.with_time_scaled(kNaN), InputError);
  CHECK_THROWS_AS(G.with_dead_time_shifted(-3.1), InputError);
  CHECK_THROWS_AS(G.with_dead_time_shifted(kNaN), InputError);
  CHECK_THROWS_AS(G.with_dead_time_shifted(kInfinity), InputError);
}

TEST_CASE("an error names what was found and what is allowed", "[transfer_function]") {
  CHECK_THROWS_WITH(TransferFunction::first_order(1, 2, -4),
                    Catch::Contains("dead time") && Catch::Contains("-4") && Catch::Contains(">= 0"));
}

}  // namespace mpm
