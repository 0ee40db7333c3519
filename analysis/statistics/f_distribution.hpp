#pragma once

namespace mpm {

/// ln P(F > f) of an F-distributed number with `numerator` and `denominator` degrees of freedom,
///
///   P(F > f) = I_x(a, b),   x = d2/(d2 + d1 f),  a = d2/2,  b = d1/2
///
/// with the regularised incomplete beta function. The logarithm, since the p-values of strong effects are
/// below the smallest number, and would all look alike.
/// @throws InputError for f below 0 or NaN, or degrees of freedom that are not above 0
double log_f_tail(double f, double numerator, double denominator);

/// f with P(F > f) = `probability` of the same distribution.
double f_upper_quantile(double probability, double numerator, double denominator);

}  // namespace mpm
