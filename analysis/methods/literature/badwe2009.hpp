#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/decorrelation.hpp"
#include "analysis/identification/noise_filter.hpp"
#include "analysis/methods/literature/mv_exclusion.hpp"
#include "analysis/methods/literature/partial_correlation.hpp"

namespace mpm {

/// The number of correlations among which the confidence is divided (Bonferroni). If each of m correlations
/// is tested at (1 - confidence)/m, independent signals give no false alarm among the m with a probability of
/// at least `confidence`.
enum class Multiplicity : std::int8_t {
  none = 0,      ///< each lag by itself
  lags = 1,      ///< the lags of a channel
  channels = 2,  ///< the lags of all channels of the loop
};

/// The choices that the method of Badwe et al. (2009) leaves open; docs/methods.md says how much each one
/// matters.
struct Badwe2009Options {
  NoiseFilter filter = NoiseFilter::automatic;
  int filter_length = 5;  ///< samples, of the moving average and the first-order filter
  DecorrelationOptions models;
  /// Lags at which the method looks for an effect of an MV on a prediction error. The first is 1, since u(k)
  /// acts after y(k): at lag 0 there is only the response of the controller to the noise of y(k).
  int min_lag = 1, max_lag = 30;
  double confidence = 0.95;
  Multiplicity multiplicity = Multiplicity::channels;
  double weakest_correlation = 0.0;  ///< correlations up to it are not "strong" (2.2.2), even if significant
  double saturated_share = 0.5;  ///< an MV is left out if it is at a limit for a larger share of the record
  double smallest_deviation = 1e-9;  ///< an MV is left out if its standard deviation, in its unit, is smaller
  /// An MV is left out if the variance of its eps1 is below this share of its own variance: it follows the
  /// others.
  double smallest_own_share = 1e-6;

  bool operator==(const Badwe2009Options&) const = default;
};

/// The record of a loop, and the output of the nominal model on it.
///
/// | symbol | member   | shape  | meaning                                                  |
/// |--------|----------|--------|----------------------------------------------------------|
/// | y      | y        | ny x N | measured CVs                                             |
/// | y_sim  | y_sim    | ny x N | G0 (u, d), the prediction of A1.2, step 2                |
/// | u      | u        | nu x N | MVs                                                      |
/// | r      | external | nr x N | setpoints, measured disturbances; for the filter `external` only |
/// |        | limits   | nu     | limits of the MVs                                        |
struct Badwe2009Record {
  Eigen::MatrixXd y, y_sim, u, external;
  MvLimits limits;

  /// @throws InputError for shapes that do not fit, no sample, no CV, no MV, or values that are not finite
  void validate() const;
};

/// One submodel, CV against MV, and whether the method names it.
struct ChannelAssessment {
  PartialCorrelation correlation;  ///< without values if the MV is not evaluated
  bool mismatch = false;           ///< the correlation is strong
};

/// The result of the method.
enum class Badwe2009Status : std::int8_t {
  ok = 0,
  no_mv = 1,  ///< no MV was left to evaluate: the record gives no information
};

/// | member   | shape   | meaning                                                                 |
/// |----------|---------|-------------------------------------------------------------------------|
/// | mv_use   | nu      | which MVs were evaluated, and why the others were not                   |
/// | channels | ny x nu | by rows, see `channel`                                                  |
/// | filter   |         | the filter that was used; automatic becomes none or external            |
/// | unusable |         | output-error models without a usable status, which were used anyway     |
struct Badwe2009Result {
  Badwe2009Status status = Badwe2009Status::ok;
  std::vector<MvUse> mv_use;
  std::vector<ChannelAssessment> channels;
  NoiseFilter filter = NoiseFilter::none;
  Eigen::Index unusable = 0;

  /// Returns the channel of a CV and an MV.
  const ChannelAssessment& channel(Eigen::Index cv, Eigen::Index mv) const;
};

/// The method of Badwe et al. (2009) as in section 2.2.2 and appendix A1.2 of the thesis: it names the
/// channels of the model that have a mismatch. The prediction error is e = y_sim - y = (G0 - G) u - v. The
/// correlation of e_j with u_i alone would name every MV that moves together with the MV of a wrong channel.
/// So the correlation is taken between the residuals of both with respect to the other MVs U^i:
///
///   u_i(k) = V1_i  U^i(k) + eps1_i    (2.5), (A1.5)
///   e_j(k) = V2_ij U^i(k) + eps2_ij   (2.6), (A1.6)
///
/// (`decorrelate`; the effect of U^i on an MV starts at lag 0, because the controller moves the MVs together,
/// its effect on an error at lag 1). A strong correlation of eps1_i and eps2_ij (`partial_correlation`) names
/// channel u_i x y_j.
///
/// `options.filter` first removes noise. MVs that are saturated or stand still are used neither as u_i nor in
/// U^i (2.4.2). An MV of which (2.5) leaves nothing is `dependent` and not evaluated.
///
/// @throws InputError for an invalid record, and as `noise_filtered`, `decorrelate` and `partial_correlation`
Badwe2009Result assess_badwe2009(const Badwe2009Record& record, const Badwe2009Options& options = {});

}  // namespace mpm
