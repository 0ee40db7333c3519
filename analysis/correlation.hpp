#pragma once

#include <Eigen/Core>

namespace mpm {

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

}  // namespace mpm
