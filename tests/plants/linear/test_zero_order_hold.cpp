#include <cmath>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "tests/plants/plant_samples.hpp"

namespace mpm {
namespace {

using samples::polynomial;

/// int_0^t e^{A s} ds B by its power series, an independent route to the exponential for |A t| of order one.
Eigen::VectorXd held_input_series(const Eigen::MatrixXd& A, const Eigen::VectorXd& B, double t) {
  Eigen::VectorXd term = B * t;
  Eigen::VectorXd sum = term;
  for (int k = 2; k < 60; ++k) {
    term = A * term * (t / k);
    sum += term;
  }
  return sum;
}

/// y(Ts) after a unit step at t = 0 from rest, for a dead time below Ts.
double first_step_value(const DiscreteChannel& channel) {
  return channel.c.dot(channel.b_now) + channel.d;
}

}  // namespace

TEST_CASE("a first-order channel has its closed-form discretisation", "[zero_order_hold]") {
  const double Ts = 4;
  for (const double eps : {0.0, 0.3, 2.0, 3.9}) {
    const DiscreteChannel channel = discretise(TransferFunction::first_order(2.5, 9, 8 + eps), Ts);
    CHECK(channel.delay == 2);
    // Rounding of one matrix exponential of order one.
    CHECK(channel.A(0, 0) == Approx(std::exp(-Ts / 9)).epsilon(1e-14));
    CHECK(channel.c(0) * channel.b_now(0) ==
          Approx(-2.5 * std::expm1(-(Ts - eps) / 9)).epsilon(1e-14).margin(1e-15));
    CHECK(channel.c(0) * channel.b_previous(0) ==
          Approx(2.5 * (std::exp(-(Ts - eps) / 9) - std::exp(-Ts / 9))).epsilon(1e-13).margin(1e-15));
    CHECK(channel.d == 0);
  }
}

TEST_CASE("the eigenvalues of A are the exponentials of the poles", "[zero_order_hold]") {
  // (10 s + 1)(4 s + 1)(s^2 + 0.2 s + 0.26): poles -0.1, -0.25, -0.1 +- 0.5i
  const Eigen::VectorXd a = polynomial({40, 22, 14.2, 3.84, 0.26});
  const DiscreteChannel channel = discretise({polynomial({1}), a, 0.5}, 2);
  const Eigen::MatrixXd& A = channel.A;
  const double e1 = std::exp(-0.2);
  const double e2 = std::exp(-0.5);
  // The trace and the determinant are sums and products of O(1) numbers with an error of about 1e-15 each.
  CHECK(A.trace() == Approx(e1 + e2 + 2 * std::exp(-0.2) * std::cos(1.0)).epsilon(1e-12));
  CHECK(A.determinant() == Approx(e1 * e2 * std::exp(-0.4)).epsilon(1e-12));
  CHECK(A.eigenvalues().cwiseAbs().maxCoeff() == Approx(e1).epsilon(1e-12));
}

TEST_CASE("the held input agrees with the power series of the exponential", "[zero_order_hold]") {
  // Own companion realisation of (-s^3 + 3 s^2 + s + 2) / (2 s + 1)^4, neither scaled nor balanced.
  const TransferFunction G(polynomial({-1, 3, 1, 2}), polynomial({16, 32, 24, 8, 1}));
  Eigen::Matrix4d A;
  A << -2, -1.5, -0.5, -0.0625, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0;
  const Eigen::Vector4d B = Eigen::Vector4d::Unit(0);
  const Eigen::RowVector4d C = Eigen::RowVector4d(-1, 3, 1, 2) / 16;
  for (const double Ts : {0.01, 0.5, 2.0}) {
    const double expected = C.dot(held_input_series(A, B, Ts));
    // The series loses the digits of its largest term, e^{|A| Ts} or about 1e2.
    CHECK(first_step_value(discretise(G, Ts)) == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("the two inputs of a fractional dead time share the effect of a whole one", "[zero_order_hold]") {
  for (const TransferFunction& G : samples::every_kind()) {
    const TransferFunction rational = G.with_dead_time_shifted(-G.dead_time());
    const DiscreteChannel whole = discretise(rational, 2);
    for (const double eps : {0.001, 0.7, 1.999}) {
      const DiscreteChannel split = discretise(rational.with_dead_time_shifted(eps), 2);
      // Same realisation, two ways to the same integral of order one.
      CHECK((split.b_now + split.b_previous - whole.b_now).norm() < 1e-12);
      CHECK((split.A - whole.A).norm() < 1e-12);
    }
  }
}

TEST_CASE("a dead time of whole samples up to rounding is whole", "[zero_order_hold]") {
  const auto channel = [](double theta, double Ts) {
    return discretise(TransferFunction::first_order(1, 50, theta), Ts);
  };
  struct Case {
    double theta;
    double Ts;
    int delay;
  };
  // 0.3 / 0.1 is just below 3, 0.7 / 0.1 just below 7, and 27 / 0.1 must not leave a sliver either.
  for (const Case& c : {Case{27, 0.1, 270}, Case{0.3, 0.1, 3}, Case{0.7, 0.1, 7}, Case{28, 4, 7},
                        Case{1.1 * 3, 1.1, 3}, Case{0, 4, 0}, Case{1e-14, 4, 0}}) {
    INFO(c.theta << " / " << c.Ts);
    const DiscreteChannel discrete = channel(c.theta, c.Ts);
    CHECK(discrete.delay == c.delay);
    CHECK(discrete.b_previous.isZero(0));
  }
  // Fractions well above rounding stay.
  CHECK(channel(27.001, 0.1).delay == 270);
  CHECK(channel(26.999, 0.1).delay == 269);
  CHECK(channel(27.001, 0.1).b_previous(0) > 0);
}

TEST_CASE("a pure gain has no state", "[zero_order_hold]") {
  const DiscreteChannel channel = discretise({polynomial({3}), polynomial({2}), 5}, 2);
  CHECK(channel.A.size() == 0);
  CHECK(channel.b_now.size() == 0);
  CHECK(channel.c.size() == 0);
  CHECK(channel.d == 1.5);
  CHECK(channel.delay == 2);
}

TEST_CASE("repeated poles of any speed keep their digits", "[zero_order_hold]") {
  // 1 / (T s + 1)^4 and, with an integrator, 1 / (s (T s + 1)^2), one sample of length r T.
  for (const double T : {1e-5, 1e-2, 1.0, 1e2, 1e5}) {
    const TransferFunction lag(polynomial({1}),
                               polynomial({std::pow(T, 4), 4 * std::pow(T, 3), 6 * T * T, 4 * T, 1}));
    const TransferFunction ramp(polynomial({1}), polynomial({T * T, 2 * T, 1, 0}));
    for (const double r : {0.5, 1.0, 10.0}) {
      const double lag_step = 1 - std::exp(-r) * (1 + r + r * r / 2 + r * r * r / 6);
      const double ramp_step = T * (r - 2 + (r + 2) * std::exp(-r));
      // The closed forms cancel to 2e-3 of their terms; the discretisation itself errs by 1e-15.
      CHECK(first_step_value(discretise(lag, r * T)) == Approx(lag_step).epsilon(1e-12));
      CHECK(first_step_value(discretise(ramp, r * T)) == Approx(ramp_step).epsilon(1e-12));
    }
  }
}

TEST_CASE("poles of very different speed keep their digits", "[zero_order_hold]") {
  const double slow = 1e4;
  const double fast = 1e-2;
  const TransferFunction G(polynomial({1}), polynomial({slow * fast, slow + fast, 1}));
  for (const double Ts : {0.01, 1.0, 100.0}) {
    const double expected = (-slow * std::expm1(-Ts / slow) + fast * std::expm1(-Ts / fast)) / (slow - fast);
    // Squaring e^{A t} log2(Ts / fast), up to 13, times doubles a rounding each time.
    CHECK(first_step_value(discretise(G, Ts)) == Approx(expected).epsilon(1e-11));
  }
}

TEST_CASE("bad discretisations are refused", "[zero_order_hold]") {
  const TransferFunction G = TransferFunction::first_order(1, 5, 3);
  CHECK_THROWS_AS(discretise(G, 0), InputError);
  CHECK_THROWS_AS(discretise(G, -1), InputError);
  CHECK_THROWS_AS(discretise(G, kNaN), InputError);
  CHECK_THROWS_AS(discretise(G, kInfinity), InputError);
  CHECK_THROWS_AS(discretise(G, 2.9 / kMaxDelay), InputError);
  CHECK(discretise(G, 3.0 / kMaxDelay).delay == kMaxDelay);
  // e^{1000} overflows.
  const TransferFunction unstable(polynomial({1}), polynomial({1, -1}));
  CHECK_NOTHROW(discretise(unstable, 1));
  CHECK_THROWS_AS(discretise(unstable, 1000), InputError);
}

}  // namespace mpm
