#pragma once

#include <Eigen/Core>

#include "analysis/statistics/correlation.hpp"

namespace mpm {

/// Principal axes of the covariance of a set of pairs, C = [xx xy; xy yy]/(n - 1).
///
/// x and y are not divided by their standard deviations: with standardised values every ellipse would lie at
/// 45 degrees, and tables 2.10 and 2.11 agree with the plain covariance (see `scatter_shape`).
///
/// | symbol | member | meaning | unit |
/// |--------|--------|---------|------|
/// | alpha, gamma | angle | from the x axis to the major axis, above -90 up to 90 | degrees |
/// | a      | major  | square root of the largest eigenvalue | that of x and y |
/// | b      | minor  | square root of the smallest eigenvalue | the same |
///
/// The angle has the sign of the correlation: with y - y0 instead of y0 - y (5.4) it changes its sign, but
/// its magnitude stays. If a = b, the angle has no meaning.
struct PrincipalAxes {
  double angle = 0.0;
  double major = 0.0;
  double minor = 0.0;
};

/// Returns the principal axes of the pairs behind `sums`. All members are NaN for fewer than 2 pairs.
PrincipalAxes principal_axes(const CentredSums& sums);

/// Returns |angle| folded into 0 ... 45 degrees, the distance from the nearest axis, as (5.18) demands.
double folded_angle(double angle);

/// The ellipse that contains a pair with a given probability, if the pairs are normally distributed: figures
/// 2.4, 5.5, 5.11, 5.12, 5.19 and 5.20.
///
/// | member             | meaning | unit |
/// |--------------------|---------|------|
/// | centre_x, centre_y | means of the pairs | that of x, y |
/// | angle              | of the major axis, as in `PrincipalAxes` | degrees |
/// | semi_major, semi_minor | half diameters, sqrt(eigenvalue chi2_crit) | that of x, y |
struct ConfidenceEllipse {
  double centre_x = 0.0, centre_y = 0.0;
  double angle = 0.0;
  double semi_major = 0.0, semi_minor = 0.0;

  /// Returns whether (x, y) lies in the ellipse or on it. False for a NaN.
  bool contains(double x, double y) const;
};

/// Returns the confidence ellipse of the pairs behind `sums`, where chi2_crit is the quantile of the
/// chi-squared distribution with 2 degrees of freedom (sections 2.2.3, 5.2.4; Santos-Fernandez 2012). The
/// covariance is taken as known; with the hundreds of windows of a record the difference from Hotelling's
/// ellipse is below 2 %.
/// @throws InputError unless 0 < probability < 1
ConfidenceEllipse confidence_ellipse(const CentredSums& sums, double probability);

}  // namespace mpm
