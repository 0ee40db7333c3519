#pragma once

#include <Eigen/Core>

namespace mpm {

/// One period of one CV: its simulation error e (N) and regressors X (N x m) from the inputs. Each period
/// uses the same filters in the same order.
struct PlantAndNoise {
  Eigen::VectorXd e;
  Eigen::MatrixXd X;
};

/// The model of a CV from a healthy period: e = X b_0 + v.
///
/// | symbol    | member      | shape | meaning                                    |
/// |-----------|-------------|-------|--------------------------------------------|
/// | b_0       | b           | m     | by `refined_groups`                        |
/// | C_0       | covariance  | m x m | of b_0; large in directions that the period leaves open |
/// | v         | v           | N     | noise                                      |
/// | sigma_0^2 | variance    |       | of its innovations                         |
struct HealthyModel {
  Eigen::VectorXd b;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd v;
  double variance = 0.0;
  Eigen::Index freedom = 0;
};

/// An autoregression with a constant, by least squares: its coefficients a (p), their information, which is
/// the inverse of their covariance (p x p), and the variance of its innovations with its degrees of freedom.
struct NoiseEstimate {
  Eigen::VectorXd a;
  Eigen::MatrixXd information;
  double variance = 0.0, freedom = 0.0;
};

/// The autoregression of order p of v (N), which does not stand still.
NoiseEstimate noise_estimate(const Eigen::VectorXd& v, Eigen::Index p);

/// The variance of x about its mean, over all its samples.
double sample_variance(const Eigen::VectorXd& x);

/// The least information along a direction that a period leaves open, relative to the largest information of
/// a coefficient.
inline constexpr double kLeastInformation = 1e-9;
/// Below this share of the variance that the plant explains, the rest does not count as noise.
inline constexpr double kLeastNoiseShare = 0.01;

/// The model of a period. @throws InputError as `refined_groups`
HealthyModel healthy_model(const PlantAndNoise& period);

/// The distances of the plant and the noise of a period from those of a healthy period. Each is divided by
/// the distance that chance exceeds with a given probability: above 1 something has changed.
///
/// | member         | distance                                                                         |
/// |----------------|----------------------------------------------------------------------------------|
/// | plant          | s' (sigma^2 I + M C_0 M')^-1 s / rank                                            |
/// | noise_model    | (a - a_0)' (C_a + C_a0)^-1 (a - a_0) / p of the autoregressions of v             |
/// | noise_variance | the larger of sigma^2 / sigma_0^2 and its inverse, of the innovations            |
///
/// with s = Q'r for e - X b_0 and M = Q'(A X), the regression of `prewhitened_groups`. Both autoregressions
/// have the order p = `kHighestNoiseOrder`.
struct ModelComparison {
  double plant = 0.0, noise_model = 0.0, noise_variance = 0.0;
};

/// Compares a period with a healthy model. The plant is tested at b_0, with the noise model of e - X b_0,
/// instead of by the distance of two estimates, because drifting noise makes the covariance of an estimate
/// too small. v is e - X b_0 if the plant is unchanged, and e - X b of `refined_groups` if it has changed. In
/// the second case a v of less than 1 % of the variance of X b tells nothing about the noise, because it may
/// be the part of the mismatch that the filters cannot follow. The limits are quantiles of F(rank, freedom),
/// F(p, the smaller freedom of the two) and F(freedom, freedom_0), the last with half of the probability on
/// each side. All distances are 0 if one of the errors is 0.
/// @throws InputError as `refined_groups`, and for a different number of regressors
ModelComparison compare_models(const PlantAndNoise& now, const HealthyModel& before, double probability);

}  // namespace mpm
