#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "analysis/statistics/truncated_normal.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The same by the rule of Simpson.
double integral(double low, double high, double mean, double deviation) {
  constexpr int kCells = 2000;
  const double h = (high - low) / kCells;
  double sum = 0.0;
  for (int i = 0; i <= kCells; ++i) {
    const double z = (low + i * h - mean) / deviation;
    sum += (i == 0 || i == kCells ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * std::exp(-0.5 * z * z);
  }
  return sum * h / 3.0;
}

}  // namespace

TEST_CASE(
    "the integral of a normal density between two ends is that of a sum, in the middle and in the tails") {
  for (const double mean : {-3.0, 0.2, 0.9, 8.0})
    for (const double deviation : {0.3, 1.0, 1e3, 1e6})
      CHECK(log_normal_integral(0.0, 1.0, mean, deviation) ==
            Approx(std::log(integral(0.0, 1.0, mean, deviation))).margin(1e-8));
  // Far in a tail it is that of an exponential function of the slope z at the near end, to O(1/z^2).
  const double z = 1e4;
  CHECK(log_normal_integral(z, z + 1.0, 0.0, 1.0) == Approx(-0.5 * z * z - std::log(z)).margin(1e-6));
  CHECK(log_normal_integral(-z - 1.0, -z, 0.0, 1.0) == log_normal_integral(z, z + 1.0, 0.0, 1.0));
  CHECK(log_normal_integral(0.0, 2.0, 0.5, kInfinity) == Approx(std::log(2.0)));
  CHECK(log_normal_integral(1.0, 1.0, 0.0, 1.0) == -kInfinity);
}

TEST_CASE("the quantiles of a mixture of cut-off normal densities") {
  // Two halves of a normal distribution are the whole of it.
  const std::vector<TruncatedNormal> halves{{0.0, 1.0, 2.0, -30.0, 1.0}, {0.0, 1.0, 2.0, 1.0, 30.0}};
  CHECK(mixture_quantile(halves, 0.5) == Approx(1.0).margin(1e-9));
  CHECK(mixture_quantile(halves, 0.975) == Approx(1.0 + 2.0 * 1.959964).margin(1e-5));
  // Flat parts with the masses 1 and 3.
  const std::vector<TruncatedNormal> flat{{std::log(1.0), 0.5, kInfinity, 0.0, 1.0},
                                          {std::log(3.0), 1.5, kInfinity, 1.0, 2.0},
                                          {-kInfinity, 9.0, 1.0, 8.0, 9.0}};
  CHECK(mixture_quantile(flat, 0.25) == Approx(1.0).margin(1e-9));
  CHECK(mixture_quantile(flat, 0.625) == Approx(1.5).margin(1e-9));
  CHECK(mixture_quantile(flat, 0.0) == 0.0);
  CHECK(mixture_quantile(flat, 1.0) == 2.0);
  CHECK(std::isnan(mixture_quantile({}, 0.5)));
}

TEST_CASE("the shortest interval of a mixture leaves out what is least dense, and no end that is densest") {
  constexpr double kZ = 1.959964;  // of 95 %, two-sided
  const Interval whole = shortest_interval({{0.0, 1.0, 2.0, -30.0, 30.0}}, 0.95);
  CHECK(whole.lower == Approx(1.0 - 2.0 * kZ).margin(1e-5));
  CHECK(whole.upper == Approx(1.0 + 2.0 * kZ).margin(1e-5));
  const Interval falling = shortest_interval({{0.0, 0.0, 1.0, 0.0, 30.0}}, 0.95);
  CHECK(falling.lower == 0.0);
  CHECK(falling.upper == Approx(kZ).margin(1e-5));
  const Interval rising = shortest_interval({{0.0, 3.0, 1.0, -30.0, 3.0}}, 0.95);
  CHECK(rising.upper == 3.0);
  CHECK(rising.lower == Approx(3.0 - kZ).margin(1e-5));
  // Flat parts with the masses 1 and 3: the second one is as much as is asked for.
  const Interval dense = shortest_interval(
      {{std::log(1.0), 0.5, kInfinity, 0.0, 1.0}, {std::log(3.0), 1.5, kInfinity, 1.0, 2.0}}, 0.75);
  CHECK(dense.lower == Approx(1.0).margin(1e-9));
  CHECK(dense.upper == Approx(2.0).margin(1e-9));
  CHECK(std::isnan(shortest_interval({}, 0.5).lower));
}

}  // namespace mpm
