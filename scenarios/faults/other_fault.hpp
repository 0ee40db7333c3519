#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/distribution.hpp"

// What can be wrong in a loop whose model is right and whose plant nobody disturbs: instruments, valves,
// limits and operators. An assessment of the model should not call it a mismatch.

namespace mpm {

enum class OtherFaultKind : std::int8_t {
  sensor_bias = 0,
  sensor_drift = 1,
  stiction = 2,
  deadband = 3,
  md_gain = 4,
  md_noise = 5,
  limit = 6,
  held_mv = 7,
};

template <>
inline constexpr auto kWords<OtherFaultKind> = word_list("sensor_bias", "sensor_drift", "stiction",
                                                         "deadband", "md_gain", "md_noise", "limit",
                                                         "held_mv");
inline constexpr auto kOtherFaultKinds = enumerators<OtherFaultKind>();

/// What a fault of this kind is about.
enum class VariableSort { cv, mv, md };
VariableSort sort_of(OtherFaultKind kind);

/// | kind         | variable | size                                                        |
/// |--------------|----------|-------------------------------------------------------------|
/// | sensor_bias  | CV       | added to its measurement, CV unit                           |
/// | sensor_drift | CV       | added at the end of the record, on a line from the onset on |
/// | stiction     | MV       | S of the valve, MV unit (StickyValve); its J is `jump`      |
/// | deadband     | MV       | S of the valve, J = 0                                       |
/// | md_gain      | MD       | factor of its measurement                                   |
/// | md_noise     | MD       | standard deviation of white noise on it, MD unit            |
/// | limit        | CV       | added to both soft limits in the controller, CV unit        |
/// | held_mv      | MV       | none: it stays where it is, nobody tells the controller     |
///
/// Those of a measurement begin with the onset, those of an MV or a limit at Onset::sample.
///
/// A method sees the measurements, what the controller asks of a valve, and the value of an MV that is held.
/// It does not see the new limit.
struct OtherFault {
  OtherFaultKind kind;
  Eigen::Index variable;  ///< place of the CV, MV or MD
  double size = kNaN;
  double jump = 0.0;  ///< J of a sticking valve, MV unit

  friend bool operator==(const OtherFault& a, const OtherFault& b);
};

/// Ranges of the random faults of this sort.
struct OtherRanges {
  /// Relative frequency of each kind, in their order. One that the loop cannot have is never drawn.
  std::array<double, kOtherFaultKinds.size()> weight{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  /// Bias or final drift of a sensor over the standard deviation of its noise, with either sign.
  Distribution sensor = Distribution::uniform(5.0, 20.0);
  /// S of a valve over the range between the hard limits of its MV; over 1 where there is none.
  Distribution valve = Distribution::uniform(0.02, 0.1);
  /// J of a sticking valve over its S.
  Distribution jump = Distribution::uniform(0.2, 1.0);
  Distribution md_gain = Distribution::uniform(0.3, 1.7);
  /// Standard deviation of the noise of an MD, MD unit.
  Distribution md_noise = Distribution::uniform(0.05, 0.5);
  /// Shift of both soft limits of a CV over its width, 1 where a side has none; with either sign.
  Distribution limit = Distribution::uniform(0.1, 0.5);
  /// Sizes are scaled until the loop has this effect (FaultScales); none: they are as drawn.
  std::optional<Distribution> impact = {};

  bool operator==(const OtherRanges&) const = default;
};

/// A control valve with stiction: the two-parameter model of Choudhury, Thornhill and Shah ("Modelling valve
/// stiction", Control Engineering Practice 13, 2005, 641-658), with the stop at every reversal as Kano et al.
/// (2004) have it. The stem rests when the signal stops or turns. It moves again when the signal is S beyond
/// the point u_s of its rest in the other direction, or J in the same one. A moving stem stands at
///
///   x = u - d (S - J) / 2,   d = 1 upwards, -1 downwards,
///
/// so that it jumps by J when it breaks loose after a reversal, and lags by the deadband S - J. J = 0 is a
/// deadband without a jump.
class StickyValve {
 public:
  /// At rest where the signal is `u`. All in the unit of the MV. Errors: InputError unless S and J are finite
  /// and >= 0.
  StickyValve(double stickband, double jump, double u);

  /// Position of the stem after the signal `u`.
  double follow(double u);

 private:
  double stickband_, jump_;
  double position_, previous_, rest_;
  double last_move_ = 0.0;
  double direction_ = 1.0;
  bool rests_ = true;
};

}  // namespace mpm
