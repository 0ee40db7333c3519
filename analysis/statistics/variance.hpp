#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Sample variance about the mean, sum (x - mean x)^2 / (N - 1).
/// @throws InputError for fewer than 2 samples or values that are not finite
double variance(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Variance about a given setpoint, sum (x - setpoint)^2 / N. It divides by N, not N - 1, because the centre
/// is not estimated.
/// @throws InputError for no sample or values that are not finite
double variance_about(const Eigen::Ref<const Eigen::VectorXd>& signal, double setpoint);

/// Variance about a setpoint that changes with time, sum (x_k - setpoint_k)^2 / N.
/// @throws InputError for no sample, different lengths or values that are not finite
double variance_about(const Eigen::Ref<const Eigen::VectorXd>& signal,
                      const Eigen::Ref<const Eigen::VectorXd>& setpoint);

/// Setpoints of the CVs of a loop. Entry i has one value per sample if the CV has a setpoint; it is empty if
/// the CV is kept in a range.
using SetpointTrajectories = std::vector<std::optional<Eigen::VectorXd>>;

/// Variance of each CV of y, ny x N: about its setpoint if it has one, about the mean if not; `y_set` is
/// empty when no CV has one.
/// @throws InputError for a number of setpoints other than 0 or ny, and as `variance` and `variance_about`
Eigen::VectorXd variances(const Eigen::Ref<const Eigen::MatrixXd>& y, const SetpointTrajectories& y_set = {});

/// Quotient of two variances. A denominator of 0 gives +infinity, and NaN when the numerator is 0 as well.
double variance_ratio(double numerator, double denominator);

/// Variance index of a measured output y against a reference y_ref,
///
///   Ivar = var(y - mean y) / var(y_ref - mean y_ref)
///
/// It is Ivar for y_ref = y0 (6.7), Ivar_diag for y_ref = y0_diag (6.8) and Ivar_basis if y_ref is the output
/// of the basis case (6.22). 1 means that the reference explains y; a value above 1 means that mismatch or
/// disturbance made the loop worse.
///
/// A variance up to (4 eps max|x|)^2, the rounding of a constant signal, counts as 0; see `variance_ratio`.
/// @throws InputError for fewer than 2 samples, different lengths or values that are not finite
double variance_index(const Eigen::Ref<const Eigen::VectorXd>& y,
                      const Eigen::Ref<const Eigen::VectorXd>& y_ref);

/// Variance index about a setpoint, Ivar = var(y - y_set)/var(y_ref - y_set): (3.24) for y_ref = y0, (4.14)
/// for y_ref = y0_diag, with one setpoint a sample. `var` of a control error is its mean square. If it were
/// taken about the mean of the error, an offset would not count, and under a constant setpoint (A2.3) would
/// be the same as (A2.4). Zero variances are treated as in the index about the means.
/// @throws InputError for no sample, different lengths or values that are not finite
double variance_index(const Eigen::Ref<const Eigen::VectorXd>& y,
                      const Eigen::Ref<const Eigen::VectorXd>& y_ref,
                      const Eigen::Ref<const Eigen::VectorXd>& y_set);

/// Variance index of each CV: about its setpoint if it has one, (3.24), (A2.3), and otherwise about the
/// means, (6.7), (A2.4).
///
/// | symbol | meaning | shape | unit |
/// |--------|---------|-------|------|
/// | y, y_ref | measured output and its reference | ny x N | those of the CVs |
/// | y_set  | setpoints; empty when no CV has one | ny | the same |
///
/// @throws InputError for different shapes, a number of setpoints other than 0 or ny, and as `variance_index`
Eigen::VectorXd variance_indices(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                 const Eigen::Ref<const Eigen::MatrixXd>& y_ref,
                                 const SetpointTrajectories& y_set = {});

}  // namespace mpm
