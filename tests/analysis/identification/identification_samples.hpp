#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm::testing {

/// Steps to levels uniform on [-1, 1], each held for 3 to 20 samples; one row a signal.
inline Eigen::MatrixXd random_steps(Eigen::Index rows, Eigen::Index samples, std::uint64_t number) {
  RandomStream stream(2015, number, StreamId::excitation);
  Eigen::MatrixXd signals(rows, samples);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index k = 0; k < samples;) {
      const double level = stream.uniform(-1.0, 1.0);
      const auto end = std::min<Eigen::Index>(samples, k + 3 + static_cast<Eigen::Index>(stream.below(18)));
      for (; k < end; ++k)
        signals(row, k) = level;
    }
  }
  return signals;
}

/// One row of white noise an input.
inline Eigen::MatrixXd white_inputs(Eigen::Index rows, Eigen::Index samples, std::uint64_t number) {
  Eigen::MatrixXd signals(rows, samples);
  for (Eigen::Index row = 0; row < rows; ++row)
    signals.row(row) =
        white_noise(samples, 1000 * (number + 1) + static_cast<std::uint64_t>(row)).transpose();
  return signals;
}

/// A y = sum_j q^-delay B_j u_j + e, the same nb and delay for `nu` inputs.
inline ModelOrder arx_order(Eigen::Index nu, Eigen::Index na, Eigen::Index nb, Eigen::Index delay = 1) {
  return {na, std::vector<PathOrder>(static_cast<std::size_t>(nu), {nb, 0, delay}), 0, 0};
}

/// A y = B u + e of second order.
inline PolynomialModel arx_sample() {
  PolynomialModel model;
  model.A = Eigen::Vector3d(1.0, -1.5, 0.7);
  model.inputs = {{Eigen::Vector2d(1.0, 0.5), Eigen::VectorXd::Ones(1), 1}};
  model.noise_variance = 1.0;
  return model;
}

/// Two inputs with denominators and delays of their own, white noise on the output.
inline PolynomialModel output_error_sample() {
  PolynomialModel model;
  model.inputs = {{Eigen::Vector2d(0.5, 0.3), Eigen::Vector3d(1.0, -1.2, 0.5), 1},
                  {Eigen::VectorXd::Constant(1, -0.4), Eigen::Vector2d(1.0, -0.8), 3}};
  model.noise_variance = 0.25;
  return model;
}

/// One input and coloured noise.
inline PolynomialModel box_jenkins_sample() {
  PolynomialModel model;
  model.inputs = {{Eigen::Vector2d(0.4, 0.2), Eigen::Vector3d(1.0, -1.3, 0.6), 2}};
  model.C = Eigen::Vector2d(1.0, 0.5);
  model.D = Eigen::Vector2d(1.0, -0.85);
  model.noise_variance = 0.09;
  return model;
}

/// The output of a model with the innovations e (N), from rest.
inline Eigen::VectorXd simulate_noisy(const PolynomialModel& model, const Eigen::MatrixXd& u,
                                      const Eigen::VectorXd& e) {
  return simulate(model, u) + filter(Eigen::VectorXd::Ones(1), model.A, filter(model.C, model.D, e));
}

/// The output of a model with Gaussian innovations of its variance, from rest.
inline Eigen::VectorXd noisy_output(const PolynomialModel& model, const Eigen::MatrixXd& u,
                                    std::uint64_t number) {
  return simulate_noisy(model, u, std::sqrt(model.noise_variance) * white_noise(u.cols(), number));
}

/// Largest difference between the coefficients of two models of the same orders.
inline double parameter_distance(const PolynomialModel& a, const PolynomialModel& b) {
  return (a.parameters() - b.parameters()).cwiseAbs().maxCoeff();
}

}  // namespace mpm::testing
