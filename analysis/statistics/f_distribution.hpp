#pragma once

namespace mpm {

/// Returns ln P(F > f) of an F-distributed number with d1 = `numerator` and d2 = `denominator` degrees of
/// freedom,
///
///   P(F > f) = I_x(a, b),   x = d2/(d2 + d1 f),  a = d2/2,  b = d1/2
///
/// with the regularised incomplete beta function I_x. It returns the logarithm because the p-values of strong
/// effects lie below the smallest number of double precision and would all look alike.
/// @throws InputError for f below 0 or NaN, or degrees of freedom that are not above 0
double log_f_tail(double f, double numerator, double denominator);

/// Returns the f with P(F > f) = `probability` for the same distribution.
double f_upper_quantile(double probability, double numerator, double denominator);

}  // namespace mpm
