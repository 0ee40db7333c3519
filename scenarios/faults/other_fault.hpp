#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/valve_stem.hpp"
#include "scenarios/random/distribution.hpp"

// Faults of a loop whose model is right and whose plant is not disturbed: faults of instruments, valves,
// limits and operators. An assessment of the model should not call them a mismatch.

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
  sensor_stuck = 8,
  stick_slip = 9,
  friction = 10,
};

template <>
inline constexpr auto kWords<OtherFaultKind> = word_list("sensor_bias", "sensor_drift", "stiction",
                                                         "deadband", "md_gain", "md_noise", "limit",
                                                         "held_mv", "sensor_stuck", "stick_slip", "friction");
inline constexpr auto kOtherFaultKinds = enumerators<OtherFaultKind>();

/// The sort of a variable, such as the one that a fault concerns.
enum class VariableSort { cv, mv, md };

/// | kind         | variable | size                                                        |
/// |--------------|----------|-------------------------------------------------------------|
/// | sensor_bias  | CV       | added to its measurement, CV unit                           |
/// | sensor_drift | CV       | error at the end of the record, linear from the onset on    |
/// | sensor_stuck | CV       | none: it shows what it measured at the onset                |
/// | stiction     | MV       | S of a StickyValve, MV unit; its J is `jump`                |
/// | deadband     | MV       | S of a StickyValve, J = 0                                   |
/// | stick_slip   | MV       | d of a FrictionValve, f_S = d and f_D = 0                   |
/// | friction     | MV       | f_S of a FrictionValve, f_D = f_S - `jump`                  |
/// | md_gain      | MD       | factor of its measurement                                   |
/// | md_noise     | MD       | standard deviation of white noise on it, MD unit            |
/// | limit        | CV       | added to both soft limits in the controller, CV unit        |
/// | held_mv      | MV       | none: it stays where it is, unknown to the controller       |
///
/// The errors of a measurement grow with Onset::share(), but a drift grows to the end of the record. A stuck
/// sensor and the faults of an MV or a limit begin at Onset::sample.
///
/// A method sees the measurements, the position that the controller asks a valve to take, and the value of a
/// held MV. It does not see the new limit.
struct OtherFault {
  OtherFaultKind kind;
  Eigen::Index variable;  ///< index of the CV, MV or MD
  double size = kNaN;
  double jump = 0.0;   ///< J of a sticking valve, MV unit
  double start = 0.0;  ///< initial position of a valve that sticks from the first sample on (StickyValve)

  friend bool operator==(const OtherFault& a, const OtherFault& b);
};

/// The position of the stem of a valve that sticks from the first sample on.
enum class ValveStart : std::int8_t {
  signal = 0,   ///< where the controller asks it to be
  unknown = 1,  ///< anywhere that it can stand under this signal, drawn for each experiment
};

template <>
inline constexpr auto kWords<ValveStart> = word_list("signal", "unknown");

/// Ranges of the random faults of OtherFaultKind.
struct OtherRanges {
  /// Relative frequency of each kind, in the order of OtherFaultKind. The kinds from sensor_stuck on were
  /// added later: they are drawn only if a study asks for them. A fault that the loop cannot have is never
  /// drawn.
  std::array<double, kOtherFaultKinds.size()> weight{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  /// Bias or final drift of a sensor in standard deviations of its noise, with either sign.
  Distribution sensor = Distribution::uniform(5.0, 20.0);
  /// S, d or f_S of a valve as a share of the range between the hard limits of its MV; in MV units if there
  /// is no range.
  Distribution valve = Distribution::uniform(0.02, 0.1);
  ValveStart valve_start = ValveStart::signal;
  /// J of a sticking valve as a share of its S.
  Distribution jump = Distribution::uniform(0.2, 1.0);
  Distribution md_gain = Distribution::uniform(0.3, 1.7);
  /// Standard deviation of the noise of an MD, MD unit.
  Distribution md_noise = Distribution::uniform(0.05, 0.5);
  /// Shift of both soft limits of a CV as a share of the range between them, with either sign; in CV units if
  /// a limit is missing.
  Distribution limit = Distribution::uniform(0.1, 0.5);
  /// The effect to which sizes are scaled (FaultScales); none: sizes are as drawn.
  std::optional<Distribution> impact = {};

  bool operator==(const OtherRanges&) const = default;
};

/// What a fault changes in its loop. Several kinds of faults may change the same thing in different ways.
enum class FaultEffect : std::int8_t {
  sensor_error,  ///< something is added to the measurement of a CV
  sensor_stuck,  ///< the measurement of a CV stays what it was
  valve,         ///< a ValveStem follows the signal of an MV
  md_error,      ///< something is added to the measurement of an MD
  limit,         ///< both soft limits of a CV move in the controller
  hold,          ///< an MV stays where it is, unknown to the controller
};

/// The unit in which the range of a size is given; 1 if the loop has no such unit.
enum class SizeUnit : std::int8_t {
  own,         ///< the unit of the variable, or a factor
  noise,       ///< standard deviation of the noise of the CV
  hard_range,  ///< width of the hard limits of the MV
  soft_range,  ///< width of the soft limits of the CV
};

/// All properties of a kind of fault. To add a kind, add an enumerator with its word and a row of the table
/// in other_fault.cpp; if it changes something else in the loop, add a FaultEffect, too.
struct OtherFaultInfo {
  OtherFaultKind kind;
  const char* meaning;  ///< meaning of its key in [other.weights]
  VariableSort sort;    ///< sort of the variable that the fault concerns
  FaultEffect effect;
  Distribution OtherRanges::*size = nullptr;  ///< range from which its size is drawn; null: it has no size
  SizeUnit unit = SizeUnit::own;
  bool has_either_sign = false;
  Distribution OtherRanges::*jump = nullptr;  ///< range of OtherFault::jump / size; null: no jump
  bool is_factor = false;                     ///< its size is a factor; 1 is no fault
  bool grows_to_end = false;  ///< it reaches its size at the last sample, whatever Onset::growth says
  std::unique_ptr<ValveStem> (*stem)(const OtherFault& fault,
                                     double u) = nullptr;  ///< makes the stem of a valve at rest at u
};

const OtherFaultInfo& info_of(OtherFaultKind kind);

}  // namespace mpm
