#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/interval.hpp"
#include "base/error.hpp"
#include "tests/analysis/exact_interval.hpp"

namespace {

using mpm::Interval;
using mpm::wilson_interval;
using mpm::testing::clopper_pearson_interval;

/// log of the binomial probability of k hits in n trials.
double log_probability(int k, int n, double p) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
         (n - k) * std::log1p(-p);
}

/// Probability that the interval of a result contains the true p, over all results.
template <class Method>
double coverage(int n, double p, Method method) {
  double sum = 0.0;
  for (int k = 0; k <= n; ++k) {
    sum += method(k, n, 0.95).contains(p) ? std::exp(log_probability(k, n, p)) : 0.0;
  }
  return sum;
}

void check_published(const Interval& found, double lower, double upper) {
  CHECK(found.lower == Approx(lower).margin(0.00005));  // four decimals in print
  CHECK(found.upper == Approx(upper).margin(0.00005));
}

}  // namespace

TEST_CASE("normal quantiles") {
  CHECK(mpm::two_sided_normal_quantile(0.95) == Approx(1.959963984540054).epsilon(1e-14));
  CHECK(mpm::two_sided_normal_quantile(0.5) == Approx(0.6744897501960817).epsilon(1e-14));
}

TEST_CASE("the intervals published by Newcombe, Statistics in Medicine 17 (1998), table I") {
  check_published(wilson_interval(81, 263), 0.2553, 0.3662);
  check_published(wilson_interval(15, 148), 0.0624, 0.1605);
  check_published(wilson_interval(0, 20), 0.0, 0.1611);
  check_published(wilson_interval(1, 29), 0.0061, 0.1718);
  check_published(clopper_pearson_interval(81, 263), 0.2527, 0.3676);
  check_published(clopper_pearson_interval(15, 148), 0.0578, 0.1617);
  check_published(clopper_pearson_interval(0, 20), 0.0, 0.1684);
  check_published(clopper_pearson_interval(1, 29), 0.0009, 0.1776);
}

TEST_CASE("the ends of Wilson's interval solve |k/n - p| = z sqrt(p(1-p)/n)") {
  const double z = mpm::two_sided_normal_quantile(0.9);
  for (const int k : {1, 5, 17, 39}) {
    const Interval interval = wilson_interval(k, 40, 0.9);
    for (const double p : {interval.lower, interval.upper}) {
      CHECK(std::abs(k / 40.0 - p) == Approx(z * std::sqrt(p * (1.0 - p) / 40.0)).epsilon(1e-12));
    }
    CHECK(interval.lower < k / 40.0);
    CHECK(interval.upper > k / 40.0);
  }
}

TEST_CASE("at the ends of the exact interval the tail has the probability (1 - confidence)/2") {
  const int n = 30;
  for (const int k : {1, 7, 29}) {
    const Interval interval = clopper_pearson_interval(k, n, 0.9);
    double k_or_more = 0.0;
    double k_or_less = 0.0;
    for (int j = 0; j <= n; ++j) {
      k_or_more += j >= k ? std::exp(log_probability(j, n, interval.lower)) : 0.0;
      k_or_less += j <= k ? std::exp(log_probability(j, n, interval.upper)) : 0.0;
    }
    CHECK(k_or_more == Approx(0.05).epsilon(1e-10));  // sums of 30 terms through lgamma
    CHECK(k_or_less == Approx(0.05).epsilon(1e-10));
  }
}

TEST_CASE("coverage: exact at least 95 %, Wilson 95 % on the average") {
  double mean_wilson = 0.0;
  int points = 0;
  for (double p = 0.02; p < 0.985; p += 0.01, ++points) {
    CHECK(coverage(50, p, clopper_pearson_interval) >= 0.95);
    mean_wilson += coverage(50, p, wilson_interval);
  }
  // The average over p is 0.953 for n = 50; plain Wald intervals have 0.90.
  CHECK(mean_wilson / points == Approx(0.95).margin(0.01));
}

TEST_CASE("intervals at the ends and without trials") {
  const Interval nothing = wilson_interval(0, 0);
  CHECK(nothing.lower == 0.0);
  CHECK(nothing.upper == 1.0);
  const Interval none = wilson_interval(0, 37);
  const Interval all = wilson_interval(37, 37);
  CHECK(none.lower == 0.0);
  CHECK(all.upper == 1.0);
  CHECK(none.upper == Approx(1.0 - all.lower).epsilon(1e-12));  // symmetric, to rounding
  CHECK(none.upper > 0.0);
  CHECK(wilson_interval(10, 37, 0.99).lower < wilson_interval(10, 37, 0.95).lower);
  CHECK(wilson_interval(10, 37, 0.99).upper > wilson_interval(10, 37, 0.95).upper);
}

TEST_CASE("a rate is a share with Wilson's interval") {
  const mpm::Rate rate = mpm::rate(15, 148);
  CHECK(rate.hits == 15);
  CHECK(rate.total == 148);
  CHECK(rate.value == 15.0 / 148.0);
  CHECK(rate.interval.lower == wilson_interval(15, 148).lower);
  CHECK(rate.interval.upper == wilson_interval(15, 148).upper);
  CHECK(mpm::rate(15, 148, 0.5).interval.upper < rate.interval.upper);
  const mpm::Rate nothing = mpm::rate(0, 0);
  CHECK(std::isnan(nothing.value));
  CHECK(nothing.interval.upper == 1.0);
}

TEST_CASE("the interval of a difference is that of Newcombe's example") {
  // 56 of 70 against 48 of 80 (Newcombe 1998, table II, method 10).
  const Interval difference = mpm::difference_interval(mpm::rate(56, 70), 0.6, 80);
  CHECK(difference.lower == Approx(0.0524).margin(5e-5));
  CHECK(difference.upper == Approx(0.3339).margin(5e-5));
  // One miss in 68 says nothing against 100 % of 150, and much against 100 % for certain.
  CHECK(mpm::difference_interval(mpm::rate(67, 68), 1.0, 150).contains(0.0));
  CHECK_FALSE(mpm::rate(67, 68).interval.contains(1.0));
  CHECK_FALSE(mpm::difference_interval(mpm::rate(60, 68), 1.0, 150).contains(0.0));
  CHECK(std::isnan(mpm::difference_interval(mpm::rate(0, 0), 0.5, 10).lower));
  CHECK_THROWS_AS(mpm::difference_interval(mpm::rate(1, 2), 1.5, 10), mpm::InputError);
}

TEST_CASE("intervals refuse impossible counts and confidences") {
  using mpm::InputError;
  CHECK_THROWS_AS(wilson_interval(-1, 5), InputError);
  CHECK_THROWS_AS(wilson_interval(6, 5), InputError);
  CHECK_THROWS_AS(wilson_interval(0, -1), InputError);
  for (const double confidence : {0.0, 1.0, -0.5, 95.0, std::nan("")})
    CHECK_THROWS_AS(wilson_interval(1, 5, confidence), InputError);
  CHECK_THROWS_WITH(mpm::rate(6, 5), "number of hits: found 6; allowed: 0 to 5 (the trials)");
}
