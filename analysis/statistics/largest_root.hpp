#pragma once

#include <Eigen/Core>

namespace mpm {

/// Returns the l with P(L > l) = `probability`, where L is the largest root of two sample covariance matrices
/// of the same distribution,
///
///   det(B/b - L A/a) = 0,   A ~ W_p(I, a),  B ~ W_p(I, b), independent Wishart matrices
///
/// L is the largest ratio of two sample variances that any linear combination of p variables shows (Roy
/// 1953). With one variable, L has an F distribution. Otherwise ln(b L/a) is approximately m + s T, where T
/// has the Tracy-Widom distribution for real matrices (Johnstone 2009, Ann. Appl. Stat. 3, 1616, section 2):
///
///   m = 2 ln tan((phi + gamma)/2),   s^3 = 16/(a + b - 1)^2 / (sin^2(phi + gamma) sin phi sin gamma)
///   sin^2(gamma/2) = (min(p, b) - 1/2)/(a + b - 1),   sin^2(phi/2) = (max(p, b) - 1/2)/(a + b - 1)
///
/// T + 9.848 has approximately a gamma distribution (Chiani 2014, J. Multivar. Anal. 129, 69). In trials with
/// 2 to 7 variables and 15 to 240 degrees of freedom, L exceeds the quantile for 2.5 % in 1.5 to 2.6 % of the
/// trials.
///
/// | symbol | name          | meaning                                 | unit |
/// |--------|---------------|-----------------------------------------|------|
/// | p      | `variables`   | number of variables                     | -    |
/// | b, a   | `numerator`, `denominator` | degrees of freedom, above 0 | -    |
///
/// For p of 2 or more, +infinity if a <= p, where B may vary in a direction in which A does not, or if b < 1.
/// @throws InputError for no variable, or degrees of freedom that are not above 0
double largest_root_upper_quantile(double probability, Eigen::Index variables, double numerator,
                                   double denominator);

}  // namespace mpm
