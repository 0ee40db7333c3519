#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenarios/random/random_stream.hpp"

namespace mpm {

/// The measurement noise of a CV, in its own standard deviations: white, with an autocorrelation phi, or an
/// AR(1) state (a, b) under white noise, as a benchmark shows it if the plant is not quite its model.
struct BaseNoise {
  double deviation = 1.0;  ///< of the noise, CV unit
  double phi = 0.0;
  double a = 0.0, b = 0.0;
};

/// The fewest samples of a record from which a noise can be fitted.
inline constexpr Eigen::Index kFewestNoiseSamples = 10;

/// The noise that simulation errors `e` (N, NaN where there is no sample) of a healthy loop show: white, an
/// AR(1), or an AR(1) state under white noise, whichever has the largest log L - p log(N) / 2 with its p
/// parameters. The last one is the form of the errors if a plant differs slightly from its model. Its
/// deviation is `least` or more. Throws InputError for fewer than kFewestNoiseSamples samples.
BaseNoise fitted_base_noise(const Eigen::Ref<const Eigen::RowVectorXd>& e, double least);

/// Noises with the same phi, and the logarithm of the posterior probability of each.
struct PossibleNoises {
  double phi = 0.0;
  Eigen::ArrayXd a, b, log_weight;  ///< a and b of BaseNoise
};

/// The noises that a healthy record leaves possible: the fitted one, and all others that were tried. Before
/// the record is seen, white noise, an AR(1) with any phi, and AR(1) states under white noise are equally
/// probable.
struct NoisePosterior {
  BaseNoise best;
  std::vector<PossibleNoises> possible;  ///< empty: only `best` is
  double log_evidence = 0.0;             ///< of the record, over all noises that were tried
};

/// A slow disturbance of up to this part of the standard deviation of the measurement noise is background,
/// which healthy loops have too: it adds a quarter to the variance of the noise.
inline constexpr double kLargestBackground = 0.5;

/// N samples of this noise, CV unit, from its stationary state on.
Eigen::RowVectorXd drawn_noise(const BaseNoise& noise, Eigen::Index samples, RandomStream& random);

/// Standard deviation of the slow part of a noise over that of its white part.
double slow_part(const BaseNoise& noise);

/// Adds backgrounds that the record does not show to the possible ones: each AR(1) state up to
/// kLargestBackground gets a small part of the weight, since the background may be different next month.
void add_unseen_backgrounds(NoisePosterior& noise, Eigen::Index samples);

/// The posterior of the noise in simulation errors. The rows of `directions` (q x N, CV unit) explain a part
/// of the errors with coefficients z ~ N(0, I), which are integrated out. Throws InputError like
/// fitted_base_noise(), and if no likelihood of a noise is a number.
NoisePosterior noise_posterior(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                               const Eigen::Ref<const Eigen::MatrixXd>& directions, double least);

/// The standard deviation of white noise whose differences between neighbours are as large as those of `e` in
/// the median. Slow changes hardly add to it. Neighbours are as far apart as the samples of the signal
/// (sample_spacing()). 0 without neighbours.
double deviation_of_steps(const Eigen::Ref<const Eigen::RowVectorXd>& e);

/// Returns the record with NaN in place of outliers, as for missing samples. A sample is an outlier if it is
/// off the median of two neighbours on each side by more than six standard deviations of that distance over
/// the record (from its median), and by more than twice the range of these neighbours. So a signal that rises
/// steeply for a while keeps its samples.
Eigen::RowVectorXd without_outliers(const Eigen::Ref<const Eigen::RowVectorXd>& e);

}  // namespace mpm
