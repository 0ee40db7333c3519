#pragma once

#include <cstdint>

namespace mpm {

/// The model by which a signal is freed of the effect of others (analysis/methods/decorrelation).
enum class DecorrelationModel : std::int8_t {
  output_error = 0,  ///< output-error models by search (2.5), (2.6)
  fir = 1,           ///< regression on Laguerre filters, the finite impulse response for a pole of 0
};

/// How noise is taken out of the signals before they are correlated (A1.2, step 1;
/// analysis/methods/noise_filter).
enum class NoiseFilter : std::int8_t {
  /// `external` where at least as many signals from outside move as there are MVs to be told apart, `none`
  /// where fewer do.
  automatic = 0,
  none = 1,
  moving_average = 2,  ///< the mean of the last n samples
  first_order = 3,     ///< x_f(k) = a x_f(k-1) + (1 - a) x(k), a = exp(-1/n)
  external = 4,        ///< of the MVs only what setpoints and measured disturbances make them do
};

/// Among how many correlations the confidence is shared out (Bonferroni): with each of m correlations tested
/// at (1 - confidence)/m, independent signals give no false alarm among the m with at least `confidence`.
enum class Multiplicity : std::int8_t {
  none = 0,      ///< each lag by itself
  lags = 1,      ///< the lags of a channel
  channels = 2,  ///< the lags of all channels of the loop
};

/// What the method of Badwe et al. (2009) leaves open; docs/methods.md says how much each choice matters.
struct Badwe2009Options {
  NoiseFilter filter = NoiseFilter::automatic;
  int filter_length = 5;  ///< samples, of the moving average and the first-order filter
  DecorrelationModel model = DecorrelationModel::fir;
  int nb = 2, nf = 2;     ///< orders of B and F of each path of an output-error model
  int fir_length = 20;    ///< filters an input of the regression, one of them direct
  double fir_pole = 0.9;  ///< of its Laguerre filters, in [0, 1)
  /// Lags at which an effect of an MV on a prediction error is looked for. The first is 1, since u(k) acts
  /// after y(k): at lag 0 there is only the answer of the controller to the noise of y(k).
  int min_lag = 1, max_lag = 30;
  double confidence = 0.95;
  Multiplicity multiplicity = Multiplicity::channels;
  double weakest_correlation = 0.0;  ///< those up to it are not "strong" (2.2.2), however significant
  double saturated_share = 0.5;      ///< an MV at a limit for a larger share of the record is left out
  double smallest_deviation = 1e-9;  ///< an MV that moves less, standard deviation in its unit, is left out
  /// An MV whose eps1 has less than this share of its variance is left out: it does as the others do.
  double smallest_own_share = 1e-6;

  /// @throws InputError for a length or nb below 1, nf or a lag below 0, a largest lag below the smallest, a
  ///   pole outside [0, 1), a confidence outside (0, 1), a correlation or share outside [0, 1], or a
  ///   deviation below 0
  void validate() const;

  bool operator==(const Badwe2009Options&) const = default;
};

}  // namespace mpm
