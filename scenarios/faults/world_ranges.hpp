#pragma once

#include <string>
#include <vector>

#include "scenarios/random/distribution.hpp"

namespace mpm {

/// A parameter of a nonlinear plant that differs from world to world.
struct WorldParameter {
  std::string name = {};
  Distribution factor = Distribution::constant(1.0);  ///< of the nominal value

  bool operator==(const WorldParameter&) const = default;
};

/// The background disturbances, which never stop: independent first-order noise on every CV, and on every MV
/// between controller and plant,
///
///     x(k) = a x(k-1) + sqrt(1 - a^2) s w(k),    a = exp(-1 / time_constant),    w white, normal,
///     variance 1.
///
/// Size s and time constant are drawn once per world for each CV and each MV; w is drawn anew in each loop.
struct BackgroundRanges {
  Distribution cv_size = Distribution::constant(0.0);        ///< s, in standard deviations of the CV's noise
  Distribution mv_size = Distribution::constant(0.0);        ///< s, as a share of the MV's hard range
  Distribution time_constant = Distribution::constant(0.0);  ///< samples; 0: white
  /// Ratio of the largest s to the smallest s along a record, drawn once per world: s is multiplied by
  /// swell^(sin(2 pi k / N + phase) / 2), with a phase that is drawn anew in each loop.
  Distribution swell = Distribution::constant(1.0);

  bool operator==(const BackgroundRanges&) const = default;
};

/// The distributions of the worlds of a study ([world] of a study file). In a world every channel of the
/// plant differs a little from the model, small disturbances never stop, and the benchmark is a record of
/// this plant. The controller and the methods know only the model and the benchmark. Every number is drawn
/// separately for each channel, CV or MV.
struct WorldRanges {
  int count = 8;  ///< number of worlds; the experiments of each kind are spread evenly over them
  Distribution gain_factor = Distribution::constant(1.0);
  Distribution time_constant_factor = Distribution::constant(1.0);
  Distribution dead_time_factor = Distribution::constant(1.0);
  /// Added to the dead time, in the time unit of the plant; the resulting dead time is at least 0.
  Distribution dead_time_shift = Distribution::constant(0.0);
  /// Time constant of an added lag, relative to the sum of the time constants of the channel.
  Distribution extra_lag = Distribution::constant(0.0);
  Distribution noise_factor = Distribution::constant(1.0);  ///< of the noise of each CV
  /// c of the characteristic of each valve: if its MV has the hard limits a and b, the plant gets
  /// u + c (u - a) (b - u) / (b - a), minus the second term at the start of the loop. The gain of the MV goes
  /// from 1 + c at a to 1 - c at b, which no model contains.
  Distribution valve_curvature = Distribution::constant(0.0);
  std::vector<WorldParameter> plant_parameters = {};  ///< used instead of channels for a nonlinear plant
  BackgroundRanges background = {};
  int cost_loops = 8;  ///< pairs of loops, each with its own noise, that a fault's cost is averaged over
  /// Loops, each with its own noise, over which the gain of repairing a channel is averaged; 0: the gain is
  /// not computed.
  int repair_loops = 4;
  /// A channel whose gain in the first of these loops is below this share of the largest gain gets no further
  /// loops; 0: every channel gets all loops.
  double repair_screen = 0.0;

  bool operator==(const WorldRanges&) const = default;
};

}  // namespace mpm
