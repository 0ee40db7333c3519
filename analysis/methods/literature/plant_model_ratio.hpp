#pragma once

#include <Eigen/Core>

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// The plant-model ratio of a channel at angular frequencies w (Selvanathan and Tangirala 2010),
///
///   P(jw) = G(jw) / G0(jw) = 1 + sum_k b_k L_k(jw) / G0(jw)
///
/// of the plant that adds sum_k b_k L_k u to the output of the model. L_k are the channel_filters(), and G0
/// is the model behind its hold, both sampled. Each kind of model error has a signature in P:
///
///   gain           |P| flat and not 1, arg P = 0
///   time constant  |P| bent, 1 at w = 0
///   dead time      |P| = 1, arg P = -w delta
///
/// | symbol | name          | shape | unit                            |
/// |--------|---------------|-------|---------------------------------|
/// | G0     | channel       |       |                                 |
/// | Ts     | sample_time   | 1     | time unit of the channel        |
/// | b      | coefficients  | 3     | coefficients of its filters     |
/// | w      | frequencies   | n     | rad / time unit, up to pi / Ts  |
///
/// The sampled responses are sums over impulse responses of 30 residence times and the dead time.
/// @throws InputError for a channel that is zero or integrating, or another number of coefficients
Eigen::VectorXcd plant_model_ratio(const TransferFunction& channel, double sample_time,
                                   const Eigen::Ref<const Eigen::VectorXd>& coefficients,
                                   const Eigen::Ref<const Eigen::VectorXd>& frequencies);

/// The three numbers that people read from a plant-model ratio.
struct RatioSignature {
  double magnitude;  ///< |P| at `kLowFrequency` over the residence time of the channel
  double bend;       ///< |P| at `kHighFrequency` over the residence time, divided by `magnitude`
  double delay;      ///< -arg P / w at that frequency, time unit of the channel: the slope of the phase
};

/// The frequencies at which a signature is read, in units of the inverse residence time of the channel (with
/// its dead time).
inline constexpr double kLowFrequency = 0.1;
inline constexpr double kHighFrequency = 1.0;

/// @throws InputError as `plant_model_ratio`
RatioSignature ratio_signature(const TransferFunction& channel, double sample_time,
                               const Eigen::Ref<const Eigen::VectorXd>& coefficients);

}  // namespace mpm
