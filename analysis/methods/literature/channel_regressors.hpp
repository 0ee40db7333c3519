#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// Filters a channel of `channel_filters`: as many as first-order dynamics with another gain, time constant
/// and dead time need.
inline constexpr Eigen::Index kChannelFilters = 3;

/// The responses of filters like a channel of the model to its input, N x 3, that span what a mismatch of the
/// channel may do to the CV: Laguerre filters (Wahlberg 1991) with the time constant of the channel, behind
/// its dead time less the sample that the hold has anyway,
///
///   L_i = sqrt(1 - a^2) q^-delay / (1 - a q^-1) ((q^-1 - a)/(1 - a q^-1))^(i-1),  i = 1 ... 3
///   a = e^(-Ts/T),  delay = max(1, floor(theta/Ts))
///
/// with T the mean residence time of the channel, a at most 0.98 and 0.9 of an integrating one. The inputs go
/// in as deviations from the first sample, before which they are taken to have stood still. A channel without
/// effect has no filters: N x 0.
///
/// | symbol | name    | shape | unit                                     |
/// |--------|---------|-------|------------------------------------------|
/// | G0_ij  | channel |       |                                          |
/// | Ts     | sample_time | 1 | time unit of the channel                 |
/// | u_j    | input   | N     | MV or MD                                 |
Eigen::MatrixXd channel_filters(const TransferFunction& channel, double sample_time,
                                const Eigen::Ref<const Eigen::VectorXd>& input);

/// L_i(1), the static gain that each of the filters of the channel has.
double channel_filter_gain(const TransferFunction& channel, double sample_time);

/// Columns of `channel_gradients`: gain, time constant, dead time.
inline constexpr Eigen::Index kChannelGradients = 3;

/// The derivatives of what a channel adds to the CV with respect to the factor of its gain, the factor of its
/// time constants and the shift of its dead time, at the model: N x 3, the size of a mismatch in the units of
/// Mismatch::value. That of the gain is the response itself; the others are differences over a change of the
/// time constants by 5 % to either side and of the dead time by half a sample to either side (to no less than
/// no dead time). A channel without effect has none, N x 0; in an integrating one the column of the time
/// constant is 0. Inputs as in `channel_filters`.
Eigen::MatrixXd channel_gradients(const TransferFunction& channel, double sample_time,
                                  const Eigen::Ref<const Eigen::VectorXd>& input);

/// What a channel adds to the CV: its response to the deviations of the input from their first sample, N.
Eigen::VectorXd channel_response(const TransferFunction& channel, double sample_time,
                                 const Eigen::Ref<const Eigen::VectorXd>& input);

/// The inputs of the columns of G, the MVs and after them the MDs, from the start of the record to the last
/// sample of the loop, which may be a window of it.
Eigen::MatrixXd inputs_until(const AssessedLoop& loop);

}  // namespace mpm
