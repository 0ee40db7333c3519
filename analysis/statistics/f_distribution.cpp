#include "analysis/statistics/f_distribution.hpp"

#include <cmath>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// Below this probability the tail is summed in logarithms: boost would underflow to 0 some 150 decades
/// further down.
constexpr double kSmallTail = 1e-150;

/// Returns ln I_x(a, b) for a small x, from I_x = x^a (1 - x)^b / (a B(a, b)) sum_n prod (a + b + m)/(a + 1 +
/// m) x^n (Abramowitz and Stegun, 26.5.4). The ratio of successive terms tends to x.
double log_small_beta(double a, double b, double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int n = 0; n < 100000 && term > 1e-17 * sum; ++n) {
    term *= (a + b + n) / (a + 1.0 + n) * x;
    sum += term;
  }
  const double log_beta = boost::math::lgamma(a) + boost::math::lgamma(b) - boost::math::lgamma(a + b);
  return a * std::log(x) + b * std::log1p(-x) - std::log(a) - log_beta + std::log(sum);
}

}  // namespace

double log_f_tail(double f, double numerator, double denominator) {
  if (!(f >= 0.0))
    throw InputError("F ratio", fmt::format("{}", f), "0 or more");
  if (!(numerator > 0.0 && denominator > 0.0))
    throw InputError("degrees of freedom of an F ratio", fmt::format("{} and {}", numerator, denominator),
                     "above 0");
  const double a = 0.5 * denominator;
  const double b = 0.5 * numerator;
  const double x = denominator / (denominator + numerator * f);
  const double p = boost::math::ibeta(a, b, x);
  return p > kSmallTail ? std::log(p) : log_small_beta(a, b, x);
}

double f_upper_quantile(double probability, double numerator, double denominator) {
  return boost::math::quantile(
      boost::math::complement(boost::math::fisher_f(numerator, denominator), probability));
}

}  // namespace mpm
