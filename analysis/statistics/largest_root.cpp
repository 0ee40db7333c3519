#include "analysis/statistics/largest_root.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "analysis/statistics/chi_squared.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Returns the t with P(T > t) = `probability`. T + kShift has approximately a gamma distribution (Chiani
/// 2014, table 1).
double tracy_widom_upper_quantile(double probability) {
  constexpr double kShape = 46.446, kScale = 0.186054, kShift = 9.84801;
  return 0.5 * kScale * chi_squared_upper_quantile(probability, 2.0 * kShape) - kShift;
}

}  // namespace

double largest_root_upper_quantile(double probability, Eigen::Index variables, double numerator,
                                   double denominator) {
  if (variables < 1)
    throw InputError("variables of a largest root", fmt::format("{}", variables), "1 or more");
  if (!(numerator > 0.0 && denominator > 0.0))
    throw InputError("degrees of freedom of a largest root", fmt::format("{} and {}", numerator, denominator),
                     "above 0");
  if (variables == 1)
    return f_upper_quantile(probability, numerator, denominator);
  const auto p = static_cast<double>(variables);
  if (!(denominator > p && numerator >= 1.0))
    return kInfinity;
  const double n = denominator + numerator - 1.0;
  const double gamma = 2.0 * std::asin(std::sqrt((std::min(p, numerator) - 0.5) / n));
  const double phi = 2.0 * std::asin(std::sqrt((std::max(p, numerator) - 0.5) / n));
  const double sum = phi + gamma;
  if (!(sum < std::numbers::pi))
    return kInfinity;
  const double centre = 2.0 * std::log(std::tan(0.5 * sum));
  const double sines = std::sin(sum) * std::sin(sum) * std::sin(phi) * std::sin(gamma);
  const double scale = std::cbrt(16.0 / (n * n * sines));
  return std::exp(centre + scale * tracy_widom_upper_quantile(probability)) * denominator / numerator;
}

}  // namespace mpm
