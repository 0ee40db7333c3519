#pragma once

#include <Eigen/Core>

namespace mpm {

/// Means and centred sums of a set of pairs (x, y): all that correlation, regression line and ellipse need.
///
/// | member         | meaning                          |
/// |----------------|----------------------------------|
/// | pairs          | number of pairs n, both finite   |
/// | mean_x, mean_y | means of the members             |
/// | xx, yy         | sums of (x - mean x)^2 and of (y - mean y)^2 |
/// | xy             | sum of (x - mean x)(y - mean y)  |
struct CentredSums {
  Eigen::Index pairs = 0;
  double mean_x = 0.0, mean_y = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// The sums over the pairs of which both members are finite, in two passes. Allocates nothing.
/// @throws InputError when the lengths differ
CentredSums centred_sums(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& y);

/// Pearson's correlation coefficient over the pairs of which both members are finite:
///
///   r = sum (x - mean x)(y - mean y) / sqrt(sum (x - mean x)^2 sum (y - mean y)^2),   -1 <= r <= 1
///
/// NaN when fewer than `fewest_pairs` pairs are left, or when the standard deviation of either member is not
/// above `resolution`: the size, in the unit of the members, below which their variation is only error.
/// Allocates nothing.
/// @throws InputError when the lengths differ or fewest_pairs is below 2
double pearson_correlation(const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index fewest_pairs,
                           double resolution);

/// The same from the sums of the pairs.
/// @throws InputError when fewest_pairs is below 2
double pearson_correlation(const CentredSums& sums, Eigen::Index fewest_pairs, double resolution);

}  // namespace mpm
