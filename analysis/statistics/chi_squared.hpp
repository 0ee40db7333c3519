#pragma once

namespace mpm {

/// Returns the x with P(X <= x) = `probability`, where X has the chi-squared distribution with `freedom` > 0
/// degrees of freedom.
double chi_squared_quantile(double probability, double freedom);

/// Returns the x with P(X > x) = `probability` for the same distribution.
double chi_squared_upper_quantile(double probability, double freedom);

/// Returns P(X > x) for the same distribution.
double chi_squared_upper_tail(double x, double freedom);

}  // namespace mpm
