#pragma once

#include <cstdint>

#include "analysis/statistics/autocorrelation.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Whether a signal oscillates.
enum class Oscillation : std::int8_t {
  undetermined,  ///< no autocorrelation: the signal stands still
  absent,
  present,
};

template <>
inline constexpr auto kWords<Oscillation> = word_list("undetermined", "absent", "present");

/// The verdict on an oscillation from an autocorrelation function.
struct AcfOscillation {
  Oscillation verdict = Oscillation::undetermined;
  /// Decay ratio R of the function over half a period, 0 ... about 1; NaN unless there are two minima and a
  /// maximum.
  double decay_ratio = kNaN;
  /// Distance from the first minimum to the second; NaN as above. Unit: samples.
  double period = kNaN;
};

/// Returns decay ratio and verdict after Miao and Seborg (1999, Automatic detection of excessively
/// oscillatory feedback control loops):
///
///   R = a/b,   a: height of the first maximum above the line through the first two minima
///              b: depth of the first minimum below the line from (0, 1) to the first maximum
///
/// Heights are measured from lines rather than from the axis, so that a slow drift under the oscillation does
/// not matter. For the function of a second-order system under white noise, with w_d = w sqrt(1 - zeta^2),
///
///   r_l = exp(-zeta w l) (cos(w_d l) + zeta/sqrt(1 - zeta^2) sin(w_d l)),
///
/// R is exactly exp(-pi zeta/sqrt(1 - zeta^2)), the decay of the function over half a period. The usual
/// threshold 0.5 corresponds to quarter-amplitude decay over a period, zeta = 0.215.
///
/// A turning point is a point from which the function goes back by more than the white band, so that small
/// ripples do not count. The sample function of a signal without oscillation swings too. `present` therefore
/// needs, besides R >= threshold,
///
/// - an a above Bartlett's half band at the lag of the maximum, and
/// - three half periods (0 to minimum, to maximum, to second minimum), none of which is more than twice as
///   long as another.
///
/// If the second minimum of an oscillation lies beyond the last lag, the verdict is `absent`: the lags must
/// cover a little more than one and a half periods.
/// @throws InputError unless 0 < threshold < 1
AcfOscillation acf_oscillation(const Autocorrelation& acf, double threshold = 0.5);

}  // namespace mpm
