#pragma once

#include <Eigen/Core>

namespace mpm {

/// One period of one CV: its simulation error e (N) and regressors X (N x m) of the inputs, the same filters
/// in the same order in each period.
struct PlantAndNoise {
  Eigen::VectorXd e;
  Eigen::MatrixXd X;
};

/// The model of a CV from a healthy period: e = X b_0 + v.
///
/// | symbol    | member      | shape | meaning                                    |
/// |-----------|-------------|-------|--------------------------------------------|
/// | b_0       | b           | m     | by `refined_groups`                        |
/// | C_0       | covariance  | m x m | of b_0; large along what the period does not determine |
/// | v         | v           | N     | noise                                      |
/// | p_0       | order       |       | of its autoregression, by BIC              |
/// | sigma_0^2 | variance    |       | of its innovations                         |
struct HealthyModel {
  Eigen::VectorXd b;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd v;
  Eigen::Index order = 0;
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

/// Of x about its mean, over all its samples.
double sample_variance(const Eigen::VectorXd& x);

/// Information along a direction that a period leaves open, relative to the largest information of a
/// coefficient.
inline constexpr double kLeastInformation = 1e-9;
/// Below this share of the variance that the plant explains, the rest does not count as noise.
inline constexpr double kLeastNoiseShare = 0.01;

/// The model of a period. @throws InputError as `refined_groups`
HealthyModel healthy_model(const PlantAndNoise& period);

/// Distances of the plant and the noise of a period from those of a healthy one, each over the distance that
/// chance exceeds with a given probability: above 1 something has changed.
///
/// | member         | distance                                                                         |
/// |----------------|----------------------------------------------------------------------------------|
/// | plant          | s' (sigma^2 I + M C_0 M')^-1 s / rank                                            |
/// | noise_model    | (a - a_0)' (C_a + C_a0)^-1 (a - a_0) / p of the autoregressions of v             |
/// | noise_variance | the larger of sigma^2 / sigma_0^2 and its inverse, of the innovations            |
///
/// with s = Q'r of e - X b_0 and M = Q'(A X), the regression of `prewhitened_groups`, and both
/// autoregressions of the larger order.
struct ModelComparison {
  double plant = 0.0, noise_model = 0.0, noise_variance = 0.0;
};

/// Compares a period with a healthy model. The plant is tested at b_0, with the noise model of e - X b_0, and
/// not by the distance of two estimates, because drifting noise makes the covariance of an estimate too
/// small. v is e - X b_0 as long as the plant is the same, and e - X b of `refined_groups` when it is not. A
/// v of less than 1 % of the variance of X b then says nothing of the noise, for it may be what the filters
/// do not follow of the mismatch. The limits are quantiles of F(rank, freedom), F(p, least freedom of the
/// two) and F(freedom, freedom_0), the last with half of the probability on each side. All are 0 when one of
/// the errors is 0.
/// @throws InputError as `refined_groups`, and for other numbers of regressors
ModelComparison compare_models(const PlantAndNoise& now, const HealthyModel& before, double probability);

}  // namespace mpm
