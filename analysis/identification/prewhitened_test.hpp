#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/autoregression.hpp"

namespace mpm {

/// An F test of one or several groups of regressors.
struct FTest {
  double f = 0.0;
  Eigen::Index freedom = 0;  ///< of the numerator: independent regressors of the group, given the others
  double log_p = 0.0;        ///< ln of the p-value; 0 where the group has no regressor of its own
};

/// What groups of regressors say about a signal.
struct PrewhitenedTest {
  FTest all;                  ///< of all groups together
  std::vector<FTest> groups;  ///< of each group, given all others (partial F)
  Eigen::Index order = 0;     ///< p of the autoregression
};

/// Tests whether signals X help to predict e, given the past of e. With A(q) = 1 - a_1 q^-1 - ..., the
/// autoregression of e alone (`whiteness`), these are the F tests of b = 0 in
///
///   A(q) e(k) = c + b' A(q) x(k) + w(k)
///
/// | symbol | name    | shape     | meaning                                                              |
/// |--------|---------|-----------|----------------------------------------------------------------------|
/// | e      | e       | N         | signal to be explained; NaN where a sample is missing                |
/// | x      | groups  | N x m_g each | regressors, of which x(k) must be known before e(k) is            |
///
/// Both sides go through the same filter, and A is not fitted again together with b. If e(k-1), e(k-2), ...
/// were among the regressors instead (an ARX model, Granger's test), the test would be wrong for smooth x:
/// least squares with x takes the slow part out of e, the rest is correlated with its own past in a different
/// way, and the lags pick this up. The F ratio then grows by about p m/N of itself in white noise, and by far
/// more if e is as slow as x; docs/methods.md has the figures. If x depends on the past of e, as an MV of a
/// closed loop does, the coefficients a, which were fitted to e alone, take a part of what x could explain.
/// The test then has fewer false alarms than it states, not more (Durbin 1970, Econometrica 38, 410-421,
/// shows the same for tests of regression residuals).
///
/// PrewhitenedGroups (analysis/methods) whitens as well, but for another purpose: it estimates coefficients
/// in closed loop, removes the past of the noise from both sides, may fit A to what the groups leave, and
/// needs a record without gaps. Here A stays that of e, the past stays in, and missing samples are left out.
/// If the X_j follow the past of e, the two give different numbers, so neither can replace the other.
///
/// Regressors that depend on others, or stand still, add nothing: the degrees of freedom are ranks, with
/// columns of unit norm and the tolerance `kRegressorTolerance`.
///
/// @throws InputError for groups of other lengths, for regressors that are not finite, and if n - p - 1 less
///   the number of regressors is below `kLeastFreedom`
PrewhitenedTest prewhitened_test(const Eigen::Ref<const Eigen::VectorXd>& e,
                                 const std::vector<Eigen::MatrixXd>& groups, const Autoregression& whiteness);

/// Columns of unit norm that are this near to dependent count as dependent: some filtered signals that hardly
/// move are so.
inline constexpr double kRegressorTolerance = 1e-7;

/// Fewest degrees of freedom from which the variance of w is estimated.
inline constexpr Eigen::Index kLeastFreedom = 20;

}  // namespace mpm
