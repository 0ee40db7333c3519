#pragma once

#include <Eigen/Core>

namespace mpm {

/// What two signals of independent samples have in common, by bins.
struct BinnedInformation {
  double information = 0.0;  ///< I, nats
  double log_p = 0.0;        ///< ln of the p-value of I for independent signals
};

/// The mutual information of two signals that are sorted into bins with about equally many samples each,
///
///   I = sum_ij n_ij/N ln(N n_ij/(n_i n_j)),    2 N I ~ chi^2((rows - 1)(columns - 1))
///
/// the second for signals that are independent of each other, one of which is independent of its own past
/// as well (Wilks's theorem; the G test). Equal values stay in one bin, so that a signal of a few levels has
/// fewer bins; one that stands still has one, and I = 0.
/// Sees any dependence that shifts a distribution, where a correlation sees a linear one only.
/// @throws InputError for different lengths, fewer than 5 samples for each pair of bins, fewer than 2 bins,
/// or
///   values that are not finite
BinnedInformation binned_information(const Eigen::Ref<const Eigen::VectorXd>& x,
                                     const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index bins);

}  // namespace mpm
