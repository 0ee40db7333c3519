#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/literature/model_comparison.hpp"
#include "analysis/statistics/one_class_svm.hpp"

namespace mpm {

/// How records are cut into windows, and when a record lies outside.
struct WindowRule {
  Eigen::Index window = 0;  ///< samples
  Eigen::Index step = 0;    ///< samples between the starts of two windows
  double nu = 0.01;         ///< share of the training samples that may lie outside
  double share = 0.5;       ///< share of the windows of a record that must lie outside

  /// The number of windows of a record with this many samples.
  Eigen::Index windows(Eigen::Index samples) const {
    return samples < window ? 0 : (samples - window) / step + 1;
  }
};

/// The plants and noise models of the overlapping windows of a healthy period of one CV, and two one-class
/// support vector machines that have learnt them (Lu, Forbes, Loewen, Backstroem, Dumont and Gopaluni 2020).
///
/// In each window the noise model of e - X b_0, the autoregression of least BIC, prewhitens e and X, and
/// least squares give the plant b, as in `prewhitened_groups`. The points that the machines learn are these
/// models in units of their own standard errors, because the standard error of b grows with the noise and
/// shrinks with the excitation:
///
/// - plant (m numbers): L^-1 R (b - b_0) with R'R = (A X)'(A X) / sigma^2 and L L' = I + R C_0 R',
/// - noise (p + 1): L^-1 R (a - a_0) with R'R = C_a^-1 and L L' = I + R C_a0 R', and the logarithm of the
///   ratio of the variances of the innovations over its standard deviation,
///
/// with a of order `kHighestNoiseOrder`. b_0, a_0 and the variance of the whole period contain each of its
/// windows, so the deviations of these windows are divided by sqrt(1 - window/N). Only about N/window of the
/// windows are independent. So a machine learns from the windows and from additional random points,
/// `kMachinePoints` in all. The random points have the covariance of the windows, shrunk towards one variance
/// in all directions, which is at least 1 and has the weight m against N/window.
class HealthyWindows {
 public:
  /// @throws InputError as `refined_groups`, and if the period is not longer than a window
  HealthyWindows(const PlantAndNoise& period, const WindowRule& rule);

  /// The value of OneClassSvm::outsideness() that more than the given share of the windows of the record
  /// exceed: above 0 the record lies outside. The noise of a window is e - X b_0 if its plant lies inside,
  /// and e - X b of `refined_groups` if it lies outside. In the second case noise below 1 % of the variance
  /// of X (b - b_0) is not judged. -infinity if there is no regressor, or no noise.
  struct Outside {
    double plant, noise;
  };
  /// @throws InputError as `refined_groups`, and for a record that is shorter than a window
  Outside outside(const PlantAndNoise& record) const;

 private:
  Eigen::VectorXd plant_point(const PlantAndNoise& window, bool own) const;
  Eigen::VectorXd noise_point(const Eigen::VectorXd& v, bool own) const;
  PlantAndNoise window_of(const PlantAndNoise& record, Eigen::Index number) const;
  std::optional<OneClassSvm> machine_of(const std::vector<Eigen::VectorXd>& points) const;
  Outside outside_window(const PlantAndNoise& window) const;

  WindowRule rule_;
  HealthyModel whole_;
  NoiseEstimate noise_;
  Eigen::MatrixXd noise_covariance_;
  double own_deviation_;  ///< sqrt(1 - window/N)
  double independent_;    ///< N/window
  std::optional<OneClassSvm> plants_, noises_;
};

/// The number of points that a machine learns from, including the points of the windows.
inline constexpr Eigen::Index kMachinePoints = 300;

}  // namespace mpm
