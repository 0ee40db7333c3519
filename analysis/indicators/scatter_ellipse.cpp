#include "analysis/indicators/scatter_ellipse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "analysis/statistics/chi_squared.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// Returns the angle of the line through the origin and v, above -90 up to 90 degrees: v and -v give the same
/// line.
double line_angle(const Eigen::Vector2d& v) {
  const double angle = std::atan2(v.y(), v.x()) * kDegreesPerRadian;
  if (angle > 90.0) {
    return angle - 180.0;
  }
  return angle <= -90.0 ? angle + 180.0 : angle;
}

}  // namespace

PrincipalAxes principal_axes(const CentredSums& sums) {
  if (sums.pairs < 2) {
    return {kNaN, kNaN, kNaN};
  }
  const double degrees_of_freedom = static_cast<double>(sums.pairs - 1);
  Eigen::Matrix2d covariance;
  covariance << sums.xx, sums.xy, sums.xy, sums.yy;
  covariance /= degrees_of_freedom;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);  // eigenvalues in ascending order
  const Eigen::Vector2d deviations =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // a straight line may have -0
  return {line_angle(eigen.eigenvectors().col(1)), deviations[1], deviations[0]};
}

double folded_angle(double angle) {
  const double magnitude = std::abs(angle);
  return magnitude > 45.0 ? 90.0 - magnitude : magnitude;
}

bool ConfidenceEllipse::contains(double x, double y) const {
  const double cosine = std::cos(angle / kDegreesPerRadian);
  const double sine = std::sin(angle / kDegreesPerRadian);
  const double along = cosine * (x - centre_x) + sine * (y - centre_y);
  const double across = cosine * (y - centre_y) - sine * (x - centre_x);
  return std::hypot(along / semi_major, across / semi_minor) <= 1.0;
}

ConfidenceEllipse confidence_ellipse(const CentredSums& sums, double probability) {
  require_confidence(probability);
  const double factor = std::sqrt(chi_squared_quantile(probability, 2.0));
  const PrincipalAxes axes = principal_axes(sums);
  return {sums.mean_x, sums.mean_y, axes.angle, factor * axes.major, factor * axes.minor};
}

}  // namespace mpm
