#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/disturbance_scan.hpp"
#include "analysis/methods/ours/fault_priors.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/statistics/truncated_normal.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// The evidence for one wrong parameter of one channel, in the order of CvPrior::mismatches.
struct MismatchEvidence {
  double log_evidence;  ///< includes the weight of channel, parameter and size among the mismatches of the CV
  double best_size;
  double best_log_likelihood;
  std::vector<TruncatedNormal> sizes;  ///< the posterior of the size, with log_evidence as its total mass
};

/// Logarithms of the probability of one CV's simulation errors under each hypothesis about its fault.
struct CvEvidence {
  double healthy, mpm, ud, both;
  std::vector<MismatchEvidence> mismatch_alone, mismatch_with_disturbance;
  double disturbance_a, disturbance_b;  ///< of the best disturbance alone; b in CV units
  double sensor = -kInfinity;           ///< of a fault of its sensor, if that was asked for
};

/// Which mismatches of a CV are judged under every noise that the benchmark leaves possible. Each of the
/// others gains what these noises bring without a fault. If a fault is large against the noise, this is more
/// than the noises bring beside a mismatch that explains most of the fault, and the gain decides which
/// channel is named.
enum class JudgedMismatches : std::int8_t {
  nearest = 0,  ///< those whose likelihood is within e^2 of the largest one
  all = 1,      ///< all that might be the likeliest if they gained as much as without a fault
};

template <>
inline constexpr auto kWords<JudgedMismatches> = word_list("nearest", "all");

/// The likelihood of the record of one CV. With e = y - y_sim of the CV and u the recorded MVs,
///
///   healthy      e = n
///   mpm          e = m(theta) + n,        m(theta) = (G(theta) - G0) u of one channel and parameter
///   ud           e = x + n,               x the disturbance, a first-order lag of white noise
///   both         e = m(theta) + x + n
///
/// If errors of the model are learnt (ModelErrors), G0 is the corrected model, and what is unknown about the
/// errors is added to each hypothesis and integrated out. This is exact in closed loop, too: u(k) follows
/// from y up to sample k, so that the probability of the record is the product of the probabilities of each
/// y(k) given those before it and u, which the Kalman filter computes. The sizes theta are integrated out:
/// between neighbours on a grid m is taken as a straight line, which gives the integral in closed form. The
/// best parameters are looked at again around their best size, with the exact m and its slope. The
/// disturbance is summed over scan_disturbances().
class CvLikelihood {
 public:
  /// Standard deviation of a coefficient of what no record can tell, in those of the noise: y_sim already
  /// contains it, and what is left of it is small.
  static constexpr double kUntold = 30.0;

  /// `prior` must outlive the likelihood.
  CvLikelihood(ModelErrors model, double sample_time, const CvPrior& prior, double noise_freedom,
               bool starts_from_rest, JudgedMismatches judged = JudgedMismatches::nearest);

  /// `e` (N, CV unit) = y - y_sim of the nominal model: NaN where there is no sample; `inputs` (nu + nd x N)
  /// with `initial` (nu + nd) before it. The rows of `untold` (c x N), AssessedLoop::untold, are in e with
  /// coefficients of any size, kUntold standard deviations of the noise.
  CvEvidence of(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                const Eigen::Ref<const Eigen::VectorXd>& initial,
                const Eigen::Ref<const Eigen::MatrixXd>& untold) const;

  /// The errors as a healthy loop has them, in standard deviations of the noise, (1 + q) x N: e less the
  /// correction of the model, and below it ModelErrors::directions().
  Eigen::MatrixXd healthy_series(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                                 const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                 const Eigen::Ref<const Eigen::VectorXd>& initial,
                                 const Eigen::Ref<const Eigen::MatrixXd>& untold) const;

  /// The logarithm of the probability of such a series without a fault, in the measure of
  /// CvEvidence::healthy: under every noise that the benchmark leaves possible.
  double healthy_evidence(const Eigen::Ref<const Eigen::MatrixXd>& series) const;

  /// Adds the evidence of growing_mismatches() to that of the mismatches. Beforehand they are `share` times
  /// as probable as mismatches of the whole record. `series` is healthy_series() with the same `untold`.
  void add_growing(const Eigen::Ref<const Eigen::MatrixXd>& series,
                   const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                   const Eigen::Ref<const Eigen::VectorXd>& initial,
                   const Eigen::Ref<const Eigen::MatrixXd>& untold, double share, CvEvidence& evidence) const;

  /// Adds the evidence of any_shape_rows() with coefficients ~ N(0, 1), of one channel or of all, to that of
  /// the mismatches. Beforehand they are `share` times as probable as mismatches. `series` as above.
  void add_any_shape(const Eigen::Ref<const Eigen::MatrixXd>& series,
                     const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                     const Eigen::Ref<const Eigen::VectorXd>& initial, double share,
                     CvEvidence& evidence) const;

 private:
  /// ModelErrors::slopes(), and below them the rows of `untold`.
  Eigen::MatrixXd slopes(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial,
                         const Eigen::Ref<const Eigen::MatrixXd>& untold) const;

  ModelErrors model_;
  const CvPrior& prior_;
  double freedom_;
  bool starts_from_rest_;
  JudgedMismatches judged_;
  std::vector<MismatchResponses> responses_;  ///< one for each mismatch of the prior
};

}  // namespace mpm
