#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "scenarios/random_stream.hpp"

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

}  // namespace mpm::testing
