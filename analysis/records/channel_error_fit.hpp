#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The simulation errors of a CV, explained by errors of its channels, over the n samples that are there:
///
///   e = X a + n,    a ~ N(0, I)
///
/// with X (n x p) the responses to an error of gain, time constants and dead time of every channel by one
/// standard deviation each (relative_errors()) under the recorded inputs, without the part that no record can
/// tell (untold_columns()), which y_sim already contains.
struct ChannelErrorFit {
  std::vector<ChannelError> errors;   ///< p, the error of each column of X
  std::vector<Eigen::Index> samples;  ///< n, samples of the loop
  Eigen::VectorXd e;                  ///< n
  Eigen::MatrixXd X;
  /// Half of the mean squared difference of successive errors, also for a CV of an analyser.
  double noise = 0.0;
  Eigen::VectorXd a;  ///< the most likely errors, p
  double left = 0.0;  ///< mean (e - X a)^2
};

/// Sums over a part of the record, from which the errors of this part alone follow: X' X, X' e, e' e, n. X
/// has one more column, a constant for the part, because the constant of the whole record also contains a
/// share of what is wrong in the other parts.
struct ChannelErrorSums {
  Eigen::MatrixXd XX;
  Eigen::VectorXd Xe;
  double ee = 0.0, n = 0.0;

  ChannelErrorSums& operator+=(const ChannelErrorSums& more);
  ChannelErrorSums& operator-=(const ChannelErrorSums& less);
};

/// The sums over the samples of the loop from `first` to before `end`.
ChannelErrorSums sums_between(const ChannelErrorFit& fit, Eigen::Index first, Eigen::Index end);

/// The errors in such a part and what they leave, as ChannelErrorFit has them for the whole record.
struct PartialErrorFit {
  Eigen::VectorXd a;           ///< p
  Eigen::MatrixXd covariance;  ///< of a and the constant, p + 1 x p + 1; I if the part tells nothing
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
  double channel_score = 0.0;  ///< max |a| / 2; above a threshold of scores, a channel is wrong in the period
};

/// The habits of all CVs in a period.
struct ModelHabit {
  Eigen::Index first = 0, end = 0;               ///< samples of the period in its record
  std::vector<std::optional<NoiseHabit>> noise;  ///< of each CV; none if the period has too few samples
};

/// Fits of the CVs of a study whose channels may be off by the relative size `delta`; 0: p = 0.
class ChannelErrorFits {
 public:
  /// With a habit the fits find the errors beyond it: its X a is subtracted from e, its autoregression
  /// whitens e and X, and its variance becomes `noise`. Null: `noise` is estimated from the record itself.
  ChannelErrorFits(const Study& study, double delta, std::shared_ptr<const ModelHabit> habit = nullptr);

  /// Fits a CV of a loop or a window. Throws InputError for fewer than two samples.
  ChannelErrorFit of(const AssessedLoop& loop, Eigen::Index cv) const;

 private:
  const Study& study_;
  Eigen::Index settling_;
  std::vector<ModelErrorPrior> priors_;
  std::vector<ModelErrors> errors_;  ///< of each CV, before any record is seen; empty: the model is exact
  std::shared_ptr<const ModelHabit> habit_;
};

}  // namespace mpm
