#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// The number of filters of a channel in `channel_filters`: enough for first-order dynamics with another
/// gain, time constant and dead time.
inline constexpr Eigen::Index kChannelFilters = 3;

/// The responses of filters to the input of a channel of the model, N x 3. They span the effect that a
/// mismatch of the channel may have on the CV. They are Laguerre filters (Wahlberg 1991) with the time
/// constant of the channel, behind its dead time minus the one sample that the hold delays anyway,
///
///   L_i = sqrt(1 - a^2) q^-delay / (1 - a q^-1) ((q^-1 - a)/(1 - a q^-1))^(i-1),  i = 1 ... 3
///   a = e^(-Ts/T),  delay = max(1, floor(theta/Ts))
///
/// with T the mean residence time of the channel. a is at most 0.98, and 0.9 for an integrating channel. The
/// inputs are taken as deviations from their first sample, and are assumed to be constant before it. A
/// channel without effect has no filters: N x 0.
///
/// | symbol | name    | shape | unit                                     |
/// |--------|---------|-------|------------------------------------------|
/// | G0_ij  | channel |       |                                          |
/// | Ts     | sample_time | 1 | time unit of the channel                 |
/// | u_j    | input   | N     | MV or MD                                 |
Eigen::MatrixXd channel_filters(const TransferFunction& channel, double sample_time,
                                const Eigen::Ref<const Eigen::VectorXd>& input);

/// L_i(1), the static gain of each filter of the channel.
double channel_filter_gain(const TransferFunction& channel, double sample_time);

/// Columns of `channel_gradients`: gain, time constant, dead time.
inline constexpr Eigen::Index kChannelGradients = 3;

/// The derivatives of the contribution of a channel to the CV with respect to a factor on its gain, a factor
/// on its time constants and a shift of its dead time, at the model: N x 3, with the size of a mismatch in
/// the units of Mismatch::value. The derivative of the gain is the response itself. The others are
/// differences: of the time constants over 5 % to either side, of the dead time over half a sample to either
/// side (but not below a dead time of 0). A channel without effect has none, N x 0; for an integrating
/// channel the column of the time constant is 0. Inputs as in `channel_filters`.
Eigen::MatrixXd channel_gradients(const TransferFunction& channel, double sample_time,
                                  const Eigen::Ref<const Eigen::VectorXd>& input);

/// The contribution of a channel to the CV: its response to the deviations of the input from their first
/// sample, N.
Eigen::VectorXd channel_response(const TransferFunction& channel, double sample_time,
                                 const Eigen::Ref<const Eigen::VectorXd>& input);

/// The inputs of the columns of G, first the MVs and then the MDs, from the start of the record to the last
/// sample of the loop, which may be a window of the record.
Eigen::MatrixXd inputs_until(const AssessedLoop& loop);

}  // namespace mpm
