#pragma once

#include <optional>

#include <Eigen/Core>

namespace mpm {

/// The sample autocorrelation function of a signal, with the bands within which a signal without correlation
/// stays.
struct Autocorrelation {
  /// Entry l is the autocorrelation at lag l = 0 ... max_lag; entry 0 is 1.
  Eigen::VectorXd values;
  /// Half width of the band for white noise, z/sqrt(N), the same at every lag above 0.
  double white_band = 0.0;
  /// Half width of Bartlett's band at each lag l, which assumes that the signal is correlated below lag l but
  /// not from lag l on: z sqrt((1 + 2 sum_{j=1}^{l-1} r_j^2)/N). Entry 0 is 0; entry 1 equals `white_band`.
  Eigen::VectorXd bartlett_band;
};

/// Autocorrelation with the biased estimator, the usual one because its sequence is positive semidefinite:
///
///   r_l = sum_{k=l}^{N-1} (x_k - c)(x_{k-l} - c) / sum_{k=0}^{N-1} (x_k - c)^2
///
/// with c the mean of the signal (section 6.2), or `centre`, for instance a setpoint (section 3.2). z is the
/// two-sided normal quantile of `confidence`, 1.96 for 0.95. A signal that equals c within rounding has no
/// autocorrelation: all values and Bartlett bands are NaN.
/// @throws InputError for fewer than 2 samples, values that are not finite, max_lag outside 0 ... N - 1 or a
///   confidence outside (0, 1)
Autocorrelation autocorrelation(const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index max_lag,
                                double confidence = 0.95, std::optional<double> centre = std::nullopt);

}  // namespace mpm
