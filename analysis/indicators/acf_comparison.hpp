#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/indicators/acf_oscillation.hpp"
#include "analysis/statistics/autocorrelation.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "base/row.hpp"

namespace mpm {

/// Speed of response of the loop against that of its nominal output.
enum class LoopSpeed : std::int8_t {
  undetermined,  ///< a signal stands still, or a function does not decay within the lags and chance may be
                 ///< why
  alike,         ///< no difference beyond tolerance and chance
  slower,
  faster,
};

/// Where the modelling error that shows in the autocorrelation of a CV comes from (appendix A2, step 2).
enum class ErrorOrigin : std::int8_t {
  none,    ///< y behaves like y0, or cannot be compared with it
  own,     ///< the model of the CV itself: y0_diag is like y0
  others,  ///< models of other CVs: y0_diag is like y
  both,    ///< y0_diag lies between the two
};

template <>
inline constexpr auto kWords<LoopSpeed> = word_list("undetermined", "alike", "slower", "faster");
template <>
inline constexpr auto kWords<ErrorOrigin> = word_list("none", "own", "others", "both");

/// Options of `compare_autocorrelations`.
struct AcfComparisonOptions {
  /// Largest lag; 0 is a quarter of the record, beyond which too few products are left (Box and Jenkins).
  Eigen::Index max_lag = 0;
  /// |r| below which a function counts as decayed, 1/e: the time constant of a first-order loop.
  double decay_level = 0.36787944117144233;
  /// Decay lags whose ratio lies within 1/(1 + tolerance) ... 1 + tolerance are alike, however long the
  /// record. A little above the +-0.2 that the thesis grants Ivar for noise.
  double decay_tolerance = 0.25;
  /// Of the bands, and of the margin for chance.
  double confidence = 0.95;
  /// Decay ratio from which a signal oscillates, see `acf_oscillation`.
  double oscillation_threshold = 0.5;
  /// An `own_share` from here on is `own`, one up to 1 less it `others`: with 2/3, one distance is at least
  /// twice the other.
  double own_share = 2.0 / 3.0;

  /// @throws InputError for a level, confidence or threshold outside (0, 1), a tolerance not above 0, an
  ///   own_share outside (0.5, 1] or a negative lag
  void validate() const;
};

/// What one autocorrelation function says.
struct AcfFeatures {
  /// Lag from which on |r| stays below the decay level, except for rises that chance may make (`decay_lag`);
  /// infinite when it does not within the lags, NaN without a function. Unit: samples.
  double decay_lag = kNaN;
  AcfOscillation oscillation;
  Eigen::VectorXd values = {};  ///< the function at the lags 0 ... max_lag; NaN without one
};

/// What the autocorrelation functions of y, y0 and y0_diag of one CV say (sections 3.2, 4.2; figure A2.1).
struct AcfComparison {
  AcfFeatures y, y0, y0_diag;
  /// Half width of the band that the function of white noise stays in, `Autocorrelation::white_band`.
  double white_band = kNaN;
  /// Decay lag of y over that of y0; above 1 for a loop slower than designed. Infinite or 0 when one of them
  /// does not decay within the lags.
  double decay_lag_ratio = kNaN;
  /// Ratios within 1/margin ... margin are alike, see `compare_autocorrelations`.
  double decay_margin = kNaN;
  LoopSpeed speed = LoopSpeed::undetermined;
  /// Root mean square differences of two functions over the lags 1 ... max_lag.
  double y_from_y0 = kNaN;
  double y_from_y0_diag = kNaN;
  double y0_diag_from_y0 = kNaN;
  /// y_from_y0_diag/(y_from_y0_diag + y0_diag_from_y0): 1 when y0_diag is like y0, 0 when it is like y.
  double own_share = kNaN;
  ErrorOrigin origin = ErrorOrigin::none;

  /// y oscillates and y0 does not: figure A2.1 a, an oscillation that modelling errors cause.
  bool oscillates_by_error() const;
  /// y0 oscillates and y does not.
  bool calmed_by_error() const;
};

/// Compares the autocorrelation functions of y, y0 and y0_diag of one CV about its setpoint `y_set` (one
/// value a sample), or about their means when it has none (section 6.2).
///
/// **Speed.** The ratio of the decay lags of y and y0 must leave 1/margin ... margin, with
///
///   ln margin = max(ln(1 + tolerance), sqrt((1 - rho^2) (B_y^2 + B_y0^2))/(L |ln L|))
///
/// where L is the decay level, B Bartlett's half band at the decay lag, and rho the correlation of y and y0.
/// The second term is what chance makes of records of this length: an error B of r shifts the lag of an
/// exponential by the factor B/(L |ln L|), and records of equal spectrum and coherence rho share rho^2 of the
/// variance of r. Records under the same excitation have rho near 1, independent ones need more.
/// A function that does not decay within the lags enters with the last lag, the least its decay lag can be.
///
/// **Origin.** Asked when the speeds differ or one of y and y0 oscillates; from `own_share`.
///
/// | symbol  | meaning | shape | unit |
/// |---------|---------|-------|------|
/// | y, y0, y0_diag | records of one CV | N | any |
/// | y_set   | setpoint | N | the same |
///
/// @throws InputError for different lengths, fewer than 8 samples, values that are not finite or options that
/// are
///   invalid
AcfComparison compare_autocorrelations(const Eigen::Ref<const Eigen::VectorXd>& y,
                                       const Eigen::Ref<const Eigen::VectorXd>& y0,
                                       const Eigen::Ref<const Eigen::VectorXd>& y0_diag,
                                       const std::optional<Eigen::VectorXd>& y_set = std::nullopt,
                                       const AcfComparisonOptions& options = {});

/// The lag from which on |r| stays below `level`, between lags by linear interpolation; infinite when it does
/// not within the lags.
///
/// The sample function of a record of 20 time constants swings by 0.2 (one standard deviation) where it
/// should be 0, and often rises over 1/e once more. So a rise, a run of lags with |r| >= level after the
/// function has been below it, counts only when |r| leaves `band_factor` times Bartlett's band at one of its
/// lags.
double decay_lag(const Autocorrelation& acf, double level, double band_factor = 1.0);

/// The factor that makes Bartlett's band of `confidence` at each lag one of this confidence for all lags
/// 1 ... max_lag together (Bonferroni): 1.68 for 50 lags and 0.95.
double simultaneous_band_factor(double confidence, Eigen::Index max_lag);

/// Every number of a comparison. The functions themselves (`AcfFeatures::values`) are none of them.
std::vector<Row<AcfComparison>> acf_rows();

}  // namespace mpm
