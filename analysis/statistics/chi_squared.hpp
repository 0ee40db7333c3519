#pragma once

namespace mpm {

/// x with P(X <= x) = `probability` for X of the chi-squared distribution with `freedom` > 0 degrees of
/// freedom.
double chi_squared_quantile(double probability, double freedom);

/// x with P(X > x) = `probability` of the same distribution.
double chi_squared_upper_quantile(double probability, double freedom);

/// P(X > x) of the same distribution.
double chi_squared_upper_tail(double x, double freedom);

}  // namespace mpm
