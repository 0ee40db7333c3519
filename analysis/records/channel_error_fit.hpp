#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The simulation errors of a CV as errors of its channels explain them, over the n samples that are there:
///
///   e = X a + n,    a ~ N(0, I)
///
/// with X (n x p) the responses to an error of gain, time constants and dead time of every channel by one
/// standard deviation each (relative_errors()) under the recorded inputs, less what no record can tell
/// (untold_columns()), which y_sim has.
struct ChannelErrorFit {
  std::vector<ChannelError> errors;   ///< p, of each column
  std::vector<Eigen::Index> samples;  ///< n, of the loop
  Eigen::VectorXd e;                  ///< n
  Eigen::MatrixXd X;
  double noise =
      0.0;  ///< half of the mean squared difference of successive errors, those of a CV of an analyser too
  Eigen::VectorXd a;  ///< the most likely errors, p
  double left = 0.0;  ///< mean (e - X a)^2
};

/// Sums over a part of the record, from which its own errors follow: X' X, X' e, e' e, n. X has a further
/// column, a constant of the part: that of the whole record has a share of what is wrong in the rest of it.
struct ChannelErrorSums {
  Eigen::MatrixXd XX;
  Eigen::VectorXd Xe;
  double ee = 0.0, n = 0.0;

  ChannelErrorSums& operator+=(const ChannelErrorSums& more);
  ChannelErrorSums& operator-=(const ChannelErrorSums& less);
};

/// Of the samples of the loop from `first` to before `end`.
ChannelErrorSums sums_between(const ChannelErrorFit& fit, Eigen::Index first, Eigen::Index end);

/// What the errors are and leave in such a part, as ChannelErrorFit has it for all of it.
struct PartialErrorFit {
  Eigen::VectorXd a;           ///< p
  Eigen::MatrixXd covariance;  ///< of a and the constant, p + 1 x p + 1, and I where nothing is told
  double left = 0.0;
};

PartialErrorFit fit_of(const ChannelErrorSums& sums, double noise);

/// The errors e of a CV in a period in which nothing is wrong, or nothing new:
///
///   e = X a + n,   n(k) = sum_l a_l n(k - l) + w(k),   w ~ N(0, variance)
///
/// with X a as ChannelErrorFit has it, and n an autoregression of order 3
/// (analysis/methods/ours/coloured_noise.hpp).
struct NoiseHabit {
  Eigen::VectorXd errors = {};  ///< the most likely a of the period
  Eigen::VectorXd autoregression;
  double variance = 0.0;       ///< of w
  double differences = 0.0;    ///< ChannelErrorFit::noise of the period
  double channel_score = 0.0;  ///< max |a| / 2: above a threshold of scores a channel is wrong there
};

/// The same of all CVs.
struct ModelHabit {
  Eigen::Index first = 0, end = 0;               ///< samples of the period in its record
  std::vector<std::optional<NoiseHabit>> noise;  ///< of each CV; none where the period has too few samples
};

/// Fits of the CVs of a study whose channels may be off by the relative size `delta`; 0: p = 0.
class ChannelErrorFits {
 public:
  /// With a habit the errors are those beside it: e is without its X a, e and X are whitened by its
  /// autoregression, and `noise` is its variance; null: the record itself says what is noise.
  ChannelErrorFits(const Study& study, double delta, std::shared_ptr<const ModelHabit> habit = nullptr);

  /// Of a CV of a loop or a window. Throws InputError for fewer than two samples.
  ChannelErrorFit of(const AssessedLoop& loop, Eigen::Index cv) const;

 private:
  const Study& study_;
  Eigen::Index settling_;
  std::vector<ModelErrorPrior> priors_;
  std::vector<ModelErrors> errors_;  ///< of each CV, before anything is seen; none: the model is exact
  std::shared_ptr<const ModelHabit> habit_;
};

}  // namespace mpm
