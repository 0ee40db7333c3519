#pragma once

#include <Eigen/Core>

namespace mpm {

/// The mutual information of two binned signals, with its p-value.
struct BinnedInformation {
  double information = 0.0;  ///< I, nats
  double log_p = 0.0;        ///< ln of the p-value of I for independent signals
};

/// Returns the mutual information of two signals. Each is sorted into bins with about equally many samples,
///
///   I = sum_ij n_ij/N ln(N n_ij/(n_i n_j)),    2 N I ~ chi^2((rows - 1)(columns - 1))
///
/// The second relation holds if the signals are independent of each other and one of them is also independent
/// of its own past (Wilks's theorem; the G test). Equal values stay in one bin, so that a signal with few
/// levels has fewer bins; a signal that stands still has one bin, and I = 0. The test sees any dependence
/// that shifts a distribution, whereas a correlation sees a linear one only.
/// @throws InputError for different lengths, fewer than 5 samples for each pair of bins, fewer than 2 bins,
///   or values that are not finite
BinnedInformation binned_information(const Eigen::Ref<const Eigen::VectorXd>& x,
                                     const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index bins);

}  // namespace mpm
