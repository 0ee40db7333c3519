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
  undetermined,  ///< a signal stands still, or a function does not decay within the lags and the difference
                 ///< may be due to chance
  alike,         ///< no difference beyond tolerance and chance
  slower,
  faster,
};

/// The origin of the modelling error that shows in the autocorrelation of a CV (appendix A2, step 2).
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
  /// Largest lag; 0 means a quarter of the record, beyond which too few products are left (Box and Jenkins).
  Eigen::Index max_lag = 0;
  /// |r| below which a function counts as decayed, 1/e: the time constant of a first-order loop.
  double decay_level = 0.36787944117144233;
  /// Decay lags whose ratio lies within 1/(1 + tolerance) ... 1 + tolerance are alike, however long the
  /// record. The default is a little above the +-0.2 that the thesis allows Ivar for noise.
  double decay_tolerance = 0.25;
  /// Confidence of the bands and of the margin for chance.
  double confidence = 0.95;
  /// Decay ratio from which on a signal oscillates, see `acf_oscillation`.
  double oscillation_threshold = 0.5;
  /// The origin is `own` if AcfComparison::own_share is at least this value, and `others` if it is at most 1
  /// less this value. With 2/3, one distance is then at least twice the other.
  double own_share = 2.0 / 3.0;

  /// @throws InputError for a level, confidence or threshold outside (0, 1), a tolerance not above 0, an
  ///   own_share outside (0.5, 1) or a negative lag
  void validate() const;
};

/// Features of one autocorrelation function.
struct AcfFeatures {
  /// Lag from which on |r| stays below the decay level, except for rises that may be due to chance (see
  /// `decay_lag`). Infinite if |r| does not stay below the level within the lags, NaN if there is no
  /// function. Unit: samples.
  double decay_lag = kNaN;
  AcfOscillation oscillation;
  Eigen::VectorXd values = {};  ///< the function at the lags 0 ... max_lag; NaN if there is none
};

/// Comparison of the autocorrelation functions of y, y0 and y0_diag of one CV (sections 3.2, 4.2; figure
/// A2.1).
struct AcfComparison {
  AcfFeatures y, y0, y0_diag;
  /// Half width of the band within which the function of white noise stays, `Autocorrelation::white_band`.
  double white_band = kNaN;
  /// Decay lag of y divided by that of y0; above 1 if the loop is slower than designed. Infinite or 0 if one
  /// of the functions does not decay within the lags.
  double decay_lag_ratio = kNaN;
  /// Decay lags with a ratio within 1/margin ... margin are alike, see `compare_autocorrelations`.
  double decay_margin = kNaN;
  LoopSpeed speed = LoopSpeed::undetermined;
  /// Root mean square differences of two functions over the lags 1 ... max_lag.
  double y_from_y0 = kNaN;
  double y_from_y0_diag = kNaN;
  double y0_diag_from_y0 = kNaN;
  /// y_from_y0_diag/(y_from_y0_diag + y0_diag_from_y0): 1 if y0_diag is like y0, 0 if it is like y.
  double own_share = kNaN;
  ErrorOrigin origin = ErrorOrigin::none;

  /// Returns whether y oscillates and y0 does not: figure A2.1 a, an oscillation that modelling errors cause.
  bool oscillates_by_error() const;
  /// Returns whether y0 oscillates and y does not.
  bool calmed_by_error() const;
};

/// Compares the autocorrelation functions of y, y0 and y0_diag of one CV about its setpoint `y_set` (one
/// value per sample), or about their means if the CV has no setpoint (section 6.2).
///
/// **Speed.** The speeds differ if the ratio of the decay lags of y and y0 lies outside 1/margin ... margin,
/// with
///
///   ln margin = max(ln(1 + tolerance), sqrt((1 - rho^2) (B_y^2 + B_y0^2))/(L |ln L|))
///
/// where L is the decay level, B Bartlett's half band at the decay lag, and rho the correlation of y and y0.
/// The second term is the effect of chance in records of this length: an error B of r changes the decay lag
/// of an exponential by the relative amount B/(L |ln L|), and records of equal spectrum and coherence rho
/// share rho^2 of the variance of r. Records under the same excitation have rho near 1; independent records
/// have a wider margin. A function that does not decay within the lags enters with the last lag, the least
/// that its decay lag can be.
///
/// **Origin.** It is determined from `own_share`, and only if the speeds differ or exactly one of y and y0
/// oscillates.
///
/// | symbol  | meaning | shape | unit |
/// |---------|---------|-------|------|
/// | y, y0, y0_diag | records of one CV | N | any |
/// | y_set   | setpoint | N | the same |
///
/// @throws InputError for different lengths, fewer than 8 samples, values that are not finite or options that
///   are invalid
AcfComparison compare_autocorrelations(const Eigen::Ref<const Eigen::VectorXd>& y,
                                       const Eigen::Ref<const Eigen::VectorXd>& y0,
                                       const Eigen::Ref<const Eigen::VectorXd>& y0_diag,
                                       const std::optional<Eigen::VectorXd>& y_set = std::nullopt,
                                       const AcfComparisonOptions& options = {});

/// Returns the lag from which on |r| stays below `level`, with linear interpolation between lags; infinite if
/// |r| does not stay below it within the lags.
///
/// The sample function of a record of 20 time constants swings by 0.2 (one standard deviation) where it
/// should be 0, and often rises above 1/e once more. Therefore a rise, which is a run of lags with |r| >=
/// level after the function has been below it, counts only if |r| leaves `band_factor` times Bartlett's band
/// at one of its lags.
double decay_lag(const Autocorrelation& acf, double level, double band_factor = 1.0);

/// Returns the factor that widens Bartlett's band, which has `confidence` at each single lag, to a band with
/// this confidence for all lags 1 ... max_lag together (Bonferroni): 1.68 for 50 lags and 0.95.
double simultaneous_band_factor(double confidence, Eigen::Index max_lag);

/// Returns a row for every number of a comparison. The functions themselves (`AcfFeatures::values`) are not
/// included.
std::vector<Row<AcfComparison>> acf_rows();

}  // namespace mpm
