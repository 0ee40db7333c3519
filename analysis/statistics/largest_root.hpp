#pragma once

#include <Eigen/Core>

namespace mpm {

/// l with P(L > l) = `probability` for the largest root L of two covariance matrices of the same law,
///
///   det(B/b - L A/a) = 0,   A ~ W_p(I, a),  B ~ W_p(I, b), independent Wishart matrices
///
/// the largest ratio of two sample variances that any linear combination of p variables shows (Roy 1953).
/// With one variable it is an F-distributed number. Otherwise ln(b L/a) is about m + s T, where T follows the
/// law of Tracy and Widom for real matrices (Johnstone 2009, Ann. Appl. Stat. 3, 1616, section 2):
///
///   m = 2 ln tan((phi + gamma)/2),   s^3 = 16/(a + b - 1)^2 / (sin^2(phi + gamma) sin phi sin gamma)
///   sin^2(gamma/2) = (min(p, b) - 1/2)/(a + b - 1),   sin^2(phi/2) = (max(p, b) - 1/2)/(a + b - 1)
///
/// and T + 9.848 about a gamma distribution (Chiani 2014, J. Multivar. Anal. 129, 69). In trials with 2 to 7
/// variables and 15 to 240 degrees of freedom, L exceeds the quantile for 2.5 % in 1.5 to 2.6 % of them.
///
/// | symbol | name          | meaning                                 | unit |
/// |--------|---------------|-----------------------------------------|------|
/// | p      | `variables`   | of the vector with these covariances    | -    |
/// | b, a   | `numerator`, `denominator` | degrees of freedom, above 0 | -    |
///
/// +infinity for p of 2 or more if a <= p, where B may move and A does not, or if b < 1.
/// @throws InputError for no variable, or degrees of freedom that are not above 0
double largest_root_upper_quantile(double probability, Eigen::Index variables, double numerator,
                                   double denominator);

}  // namespace mpm
