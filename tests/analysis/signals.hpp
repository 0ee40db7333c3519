#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

#include "scenarios/random/random_stream.hpp"

namespace mpm::testing {

/// Gaussian white noise of unit variance; `number` selects one of many independent signals.
inline Eigen::VectorXd white_noise(Eigen::Index samples, std::uint64_t number) {
  RandomStream stream(2015, number, StreamId::disturbance_signal);
  Eigen::VectorXd signal(samples);
  for (double& value : signal) {
    value = stream.normal();
  }
  return signal;
}

/// First-order autoregression x_k = a x_(k-1) + w_k with unit-variance w, started at 0.
inline Eigen::VectorXd autoregression(Eigen::Index samples, double a, std::uint64_t number) {
  Eigen::VectorXd signal = white_noise(samples, number);
  for (Eigen::Index k = 1; k < samples; ++k) {
    signal[k] += a * signal[k - 1];
  }
  return signal;
}

/// The last `samples` values of a first-order autoregression that has forgotten its start.
inline Eigen::VectorXd settled_autoregression(Eigen::Index samples, double a, std::uint64_t number) {
  return autoregression(samples + 500, a, number).tail(samples);
}

/// Second-order autoregression under unit white noise whose poles give oscillations of `period` samples that
/// decay by the factor `half_period_decay` over half of it, after it has forgotten its start.
inline Eigen::VectorXd settled_second_order(Eigen::Index samples, double half_period_decay, double period,
                                            std::uint64_t number) {
  const double radius = std::pow(half_period_decay, 2.0 / period);
  const double cosine = std::cos(2.0 * std::numbers::pi / period);
  Eigen::VectorXd signal = white_noise(samples + 500, number);
  for (Eigen::Index k = 2; k < signal.size(); ++k) {
    signal[k] += 2.0 * radius * cosine * signal[k - 1] - radius * radius * signal[k - 2];
  }
  return signal.tail(samples);
}

}  // namespace mpm::testing
