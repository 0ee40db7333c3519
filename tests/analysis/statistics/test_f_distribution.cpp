#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/chi_squared.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "analysis/statistics/student.hpp"

namespace mpm {

TEST_CASE("F distribution: closed forms of the tail, down to where a probability cannot be written") {
  // Two degrees of freedom above: P(F > f) = (d/(d + 2 f))^(d/2).
  for (const double d : {1.0, 7.0, 380.0})
    for (const double f : {0.0, 0.3, 4.0, 1e3, 1e6, 1e12})
      CHECK(log_f_tail(f, 2, d) ==
            Approx(0.5 * d * std::log(d / (d + 2.0 * f))).epsilon(1e-10).margin(1e-12));
  // Two below: P(F > f) = 1 - (n f/(2 + n f))^(n/2).
  for (const double n : {1.0, 12.0, 28.0})
    CHECK(std::exp(log_f_tail(2.5, n, 2)) == Approx(1.0 - std::pow(2.5 * n / (2.0 + 2.5 * n), 0.5 * n)));
  // Both ways of the sum at the place where one takes over from the other, by the slope d ln p/d ln f.
  double above = 0.0;
  for (double f = 5.0; f < 400.0; f *= 1.01) {
    const double slope = (log_f_tail(f * 1.01, 12, 380) - log_f_tail(f, 12, 380)) / std::log(1.01);
    CHECK(slope < above);
    above = slope;
  }
  CHECK(log_f_tail(400.0, 12, 380) < -345.0);  // ln 1e-150
  CHECK_THROWS_WITH(log_f_tail(-1.0, 2, 3), Catch::Contains("F ratio: found -1"));
  CHECK_THROWS_WITH(log_f_tail(1.0, 0, 3), Catch::Contains("degrees of freedom"));
}

TEST_CASE("quantiles of the chi-squared, Student and F distributions fit tables, tails and each other") {
  CHECK(chi_squared_quantile(0.95, 1.0) == Approx(3.841458820694124));
  CHECK(chi_squared_upper_quantile(0.01, 4.0) == Approx(13.27670413598762));
  CHECK(chi_squared_upper_tail(chi_squared_quantile(0.9, 3.0), 3.0) == Approx(0.1));
  const double t = student_quantile(0.975, 7.0);
  CHECK(t == Approx(2.364624251592784));
  CHECK(two_sided_student_quantile(0.95, 7) == Approx(t));
  CHECK(student_upper_tail(t, 7) == Approx(0.025));
  CHECK(f_upper_quantile(0.05, 1.0, 7.0) == Approx(t * t));
  CHECK(std::exp(log_f_tail(f_upper_quantile(0.01, 3.0, 20.0), 3.0, 20.0)) == Approx(0.01));
}

}  // namespace mpm
