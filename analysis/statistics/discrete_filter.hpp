#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace mpm {

/// The value that a signal is assumed to have before its first sample.
enum class StartState : std::int8_t {
  rest = 0,  ///< 0: the record begins at the operating point
  held = 1,  ///< its first value: the record begins in some other steady state
};

/// Applies a rational filter in the shift operator q^-1, with a delay:
///
///   y(k) = q^-delay (b_0 + b_1 q^-1 + ...) / (1 + a_1 q^-1 + ...) x(k)
///
/// | symbol | meaning                             | shape                |
/// |--------|-------------------------------------|----------------------|
/// | b      | numerator                           | 1 or more            |
/// | a      | denominator, first coefficient 1    | 1 or more            |
/// | x, y   | signal before and after the filter  | N                    |
///
/// With `StartState::held` the filter starts in the steady state for the first value of x, where its output
/// is x(0) b(1)/a(1).
/// @throws InputError for an empty polynomial, a denominator that does not begin with 1, a delay below 0, or
///   a steady state that does not exist (a(1) = 0 and x(0) not 0)
Eigen::VectorXd filter(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<const Eigen::VectorXd>& a,
                       const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay = 0,
                       StartState start = StartState::rest);

/// Returns x(k - delay). Before the record, x is 0 or its first value, as `start` says.
Eigen::VectorXd delayed(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay, StartState start);

/// Returns the largest magnitude of the roots in z of the monic polynomial 1 + a_1 q^-1 + ... + a_n q^-n; 0
/// for n = 0. The polynomial is stable if this magnitude is below 1.
/// @throws InputError for an empty polynomial or one that does not begin with 1
double root_radius(const Eigen::Ref<const Eigen::VectorXd>& a);

/// Returns whether `root_radius` is below `radius`. The test uses the reflection coefficients of the
/// polynomial (Jury's test) and takes of the order of n^2 operations. False if a coefficient is not finite.
/// @throws InputError as `root_radius`
bool has_roots_within(const Eigen::Ref<const Eigen::VectorXd>& a, double radius);

/// Returns a monic polynomial with every root in |z| <= `radius`. A root outside the unit circle is reflected
/// in it, z -> 1/conj(z), which changes the amplitude response by a factor only. A root that is then still
/// beyond `radius` is moved back to `radius`.
/// @throws InputError for an empty polynomial, one that does not begin with 1, or a radius outside (0, 1]
Eigen::VectorXd stabilised(const Eigen::Ref<const Eigen::VectorXd>& a, double radius);

}  // namespace mpm
