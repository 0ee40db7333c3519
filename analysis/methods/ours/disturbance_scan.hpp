#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/fault_priors.hpp"

namespace mpm {

/// The likelihood from the sum of squares of n whitened samples. With the variance of the noise known up to a
/// factor that is scaled inverse chi-square with nu degrees of freedom,
///
///   log L = -log |C| / 2 - (nu + n) / 2 log(1 + SSE / nu),   or  -log |C| / 2 - SSE / 2  for nu = infinity,
///
/// except for a constant that all hypotheses share.
struct ScaleLikelihood {
  double freedom;  ///< nu
  double samples;  ///< n

  double operator()(double log_determinant, double squares) const;
  /// The inverse variance of the noise that this sum of squares implies: -2 d log L / d SSE.
  double precision(double squares) const;
};

/// Models of disturbance and noise with their weights. The prior probability that there is a disturbance is
/// not part of the weights.
struct WeighedModels {
  NoiseModels models;
  Eigen::ArrayXd log_prior;       ///< of the cell of each model
  Eigen::ArrayXd log_likelihood;  ///< of the series that was looked at

  // All but the first and the last throw InputError if no likelihood is a number above -infinity.
  Eigen::ArrayXd log_posterior() const { return log_prior + log_likelihood; }
  Eigen::Index best() const;  ///< with the largest likelihood
  /// log of the sum of the posterior: the evidence.
  double log_evidence() const;
  /// The models whose posterior is at least e^-15 of the largest one, or e^-margin.
  WeighedModels main_ones() const;
  WeighedModels within(double margin) const;
  WeighedModels only(Eigen::Index place) const;
};

/// The base noise alone.
WeighedModels base_models(const BaseNoise& base, bool starts_from_rest);

/// The evidence for a disturbance in the first row of `series` (1 + q x N, in standard deviations of the
/// noise, NaN where there is no sample), to which the others are added with unknown coefficients ~ N(0, 1):
/// the sum over the time constants of the prior and over a grid of sizes for each. The grid is made finer
/// around the largest likelihood of the first row alone, until its neighbours differ from it by less than a
/// factor of e. The variance of the base noise adds to that of the innovations of the disturbance.
WeighedModels scan_disturbances(const std::vector<DisturbancePrior>& prior, const BaseNoise& base,
                                bool starts_from_rest, const ScaleLikelihood& likelihood,
                                const Eigen::Ref<const Eigen::MatrixXd>& series);

}  // namespace mpm
