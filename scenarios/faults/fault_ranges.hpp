#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/signal_sequence.hpp"
#include "scenarios/random/distribution.hpp"

// The ranges from which the random mismatches and disturbances of a study are drawn.

namespace mpm {

/// Which channels and parameters a random mismatch changes.
enum class MismatchExtent : std::int8_t {
  parameter = 0,  ///< one parameter of one channel
  channel = 1,    ///< gain, time constant and dead time of one channel
  cv = 2,         ///< one parameter of every channel of a CV, each by its own amount
  mv = 3,         ///< the gain of every channel of an MV, all by the same factor: its actuator changes
  plant = 4,      ///< one parameter of all channels from MVs, each by its own amount
};

template <>
inline constexpr auto kWords<MismatchExtent> = word_list("parameter", "channel", "cv", "mv", "plant");
inline constexpr auto kMismatchExtents = enumerators<MismatchExtent>();

/// The parameters that random mismatches change.
inline constexpr std::array kRandomMismatchParameters{
    MismatchParameter::gain,         MismatchParameter::time_constant,    MismatchParameter::dead_time,
    MismatchParameter::second_order, MismatchParameter::inverse_response, MismatchParameter::sign};

/// A parameter of a nonlinear plant that random mismatches change.
struct PlantParameterRange {
  std::string name;
  Distribution factor;                     ///< of the nominal value
  std::vector<Eigen::Index> affected_cvs;  ///< CVs that a diagnosis should find

  bool operator==(const PlantParameterRange&) const = default;
};

/// A CV and the MV from which a channel leads to it.
using ChannelPlace = std::pair<Eigen::Index, Eigen::Index>;

/// Ranges of the random mismatches (table 6.4). Channels are pairs of a CV and an MV with non-zero gain.
struct MismatchRanges {
  std::vector<ChannelPlace> channels = {};  ///< those that a mismatch of any extent may change; empty: all
  /// Relative frequency of each of kRandomMismatchParameters; they need not sum to one.
  std::array<double, kRandomMismatchParameters.size()> parameter_weight{1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
  /// Relative frequency of each of kMismatchExtents.
  std::array<double, kMismatchExtents.size()> extent_weight{1.0, 0.0, 0.0, 0.0, 0.0};
  Distribution gain_factor = Distribution::uniform(0.3, 1.5);
  Distribution time_constant_factor = Distribution::uniform(0.3, 3.0);
  /// Added to the dead time, in the time unit of the plant. If the sum could be negative, the draw is
  /// confined to shifts that leave a dead time of at least 0 (docs/methods.md).
  Distribution dead_time_shift = Distribution::uniform(-2.0, 2.0);
  /// Time constant of an added lag, and of an added inverse response, relative to the residence time of the
  /// channel.
  Distribution second_order = Distribution::uniform(0.2, 1.0);
  Distribution inverse_response = Distribution::uniform(0.2, 1.0);
  /// The effect to which sizes are scaled (FaultScales); none: sizes are as drawn.
  std::optional<Distribution> impact = {};
  std::vector<PlantParameterRange> plant_parameters = {};  ///< used instead of channels for a nonlinear plant

  bool operator==(const MismatchRanges&) const = default;
};

/// The signal v of a random disturbance.
enum class DisturbanceShape : std::int8_t {
  white = 0,
  step = 1,
  ramp = 2,
  random_walk = 3,
  sine = 4,
  burst = 5
};

template <>
inline constexpr auto kWords<DisturbanceShape> = word_list("white", "step", "ramp", "random_walk", "sine",
                                                           "burst");
inline constexpr auto kDisturbanceShapes = enumerators<DisturbanceShape>();

/// Where a random disturbance is added.
enum class DisturbancePlace : std::int8_t {
  cv = 0,       ///< one CV
  mv = 1,       ///< an MV between controller and plant
  several = 2,  ///< two or three CVs, each through its own G_d from the same v
};

template <>
inline constexpr auto kWords<DisturbancePlace> = word_list("cv", "mv", "several");
inline constexpr auto kDisturbancePlaces = enumerators<DisturbancePlace>();

/// Ranges of the random unmeasured disturbances: G_d = gain / (time_constant s + 1) driven by v. White v is
/// normal with v_standard_deviation. A signal of another shape is scaled so that y_d has the same variance as
/// with white v: only the shape differs (docs/methods.md).
struct DisturbanceRanges {
  std::vector<Eigen::Index> cvs = {};  ///< CVs that a disturbance of a CV may act on; empty: all
  Distribution gain = Distribution::uniform(0.1, 3.0);
  Distribution time_constant = Distribution::uniform(30.0, 300.0);
  double v_standard_deviation = 1.0;               ///< of the white normal sequence, held over a sample
  SignalSequence sequence = SignalSequence::each;  ///< whether experiments share the random numbers of v
  /// Relative frequency of each of kDisturbanceShapes and of kDisturbancePlaces.
  std::array<double, kDisturbanceShapes.size()> signal_weight{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  std::array<double, kDisturbancePlaces.size()> place_weight{1.0, 0.0, 0.0};
  /// The effect to which gains are scaled (FaultScales); none: gains are as drawn.
  std::optional<Distribution> impact = {};

  bool operator==(const DisturbanceRanges&) const = default;
};

/// When the faults of an experiment begin, in samples. Both are rounded down to whole numbers.
struct OnsetRanges {
  Distribution sample = Distribution::constant(0.0);
  Distribution growth = Distribution::constant(0.0);

  bool operator==(const OnsetRanges&) const = default;
};

}  // namespace mpm
