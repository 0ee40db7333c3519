#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace mpm {

/// What is assumed of a signal before its first sample.
enum class StartState : std::int8_t {
  rest = 0,  ///< 0, a record that begins at the operating point
  held = 1,  ///< its first value, for ever: a record that begins in some other steady state
};

/// A rational filter of the shift q^-1, with a delay,
///
///   y(k) = q^-delay (b_0 + b_1 q^-1 + ...) / (1 + a_1 q^-1 + ...) x(k)
///
/// | symbol | meaning                             | shape                |
/// |--------|-------------------------------------|----------------------|
/// | b      | numerator                           | 1 or more            |
/// | a      | denominator, first coefficient 1    | 1 or more            |
/// | x, y   | signal before and after the filter  | N                    |
///
/// With `StartState::held` the filter is in the steady state of the first value of x, x(0) b(1)/a(1).
/// @throws InputError for an empty polynomial, a denominator that does not begin with 1, a delay below 0, or
/// a
///   steady state that does not exist (a(1) = 0 and x(0) not 0)
Eigen::VectorXd filter(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<const Eigen::VectorXd>& a,
                       const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay = 0,
                       StartState start = StartState::rest);

/// x(k - delay), with 0 or the first value of x before the record.
Eigen::VectorXd delayed(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay, StartState start);

/// Largest magnitude of the roots in z of the monic polynomial 1 + a_1 q^-1 + ... + a_n q^-n; 0 for n = 0.
/// The polynomial is stable when it is below 1.
/// @throws InputError for an empty polynomial or one that does not begin with 1
double root_radius(const Eigen::Ref<const Eigen::VectorXd>& a);

/// Whether `root_radius` is below `radius`, by the reflection coefficients of the polynomial (Jury's test),
/// which cost n^2 operations; NaN is not below anything.
/// @throws InputError as `root_radius`
bool has_roots_within(const Eigen::Ref<const Eigen::VectorXd>& a, double radius);

/// The monic polynomial with the same amplitude response up to a factor and every root in |z| <= `radius`: a
/// root outside of the unit circle is reflected in it, z -> 1/conj(z), and what is then still beyond `radius`
/// is drawn back to it.
/// @throws InputError for an empty polynomial, one that does not begin with 1, or a radius outside (0, 1]
Eigen::VectorXd stabilised(const Eigen::Ref<const Eigen::VectorXd>& a, double radius);

}  // namespace mpm
