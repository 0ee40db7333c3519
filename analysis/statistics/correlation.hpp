#pragma once

#include <Eigen/Core>

namespace mpm {

/// Means and centred sums of a set of pairs (x, y): all that a correlation, a regression line or an ellipse
/// needs.
///
/// | member         | meaning                          |
/// |----------------|----------------------------------|
/// | pairs          | number n of pairs, both members finite |
/// | mean_x, mean_y | means of x and y                 |
/// | xx, yy         | sums of (x - mean x)^2 and of (y - mean y)^2 |
/// | xy             | sum of (x - mean x)(y - mean y)  |
struct CentredSums {
  Eigen::Index pairs = 0;
  double mean_x = 0.0, mean_y = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// Returns the sums over the pairs whose members are both finite, in two passes. Allocates nothing.
/// @throws InputError when the lengths differ
CentredSums centred_sums(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& y);

/// Returns Pearson's correlation coefficient over the pairs whose members are both finite:
///
///   r = sum (x - mean x)(y - mean y) / sqrt(sum (x - mean x)^2 sum (y - mean y)^2),   -1 <= r <= 1
///
/// NaN if fewer than `fewest_pairs` pairs are left, or if the standard deviation of x or y is not above
/// `resolution`: the size, in the unit of x and y, below which their variation is only error. Allocates
/// nothing.
/// @throws InputError when the lengths differ or fewest_pairs is below 2
double pearson_correlation(const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index fewest_pairs,
                           double resolution);

/// Returns the same coefficient, computed from the sums of the pairs.
/// @throws InputError when fewest_pairs is below 2
double pearson_correlation(const CentredSums& sums, Eigen::Index fewest_pairs, double resolution);

}  // namespace mpm
