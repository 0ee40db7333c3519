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

/// The disturbances that are always there: first-order noise on every CV, and on every MV between controller
/// and plant, each independent,
///
///     x(k) = a x(k-1) + sqrt(1 - a^2) s w(k),    a = exp(-1 / time_constant),    w white, normal,
///     variance 1.
///
/// Size s and time constant are drawn once a world for each CV and each MV, the sequence w in each loop anew.
struct BackgroundRanges {
  Distribution cv_size = Distribution::constant(0.0);  ///< s, in standard deviations of the CV's noise
  Distribution mv_size = Distribution::constant(0.0);  ///< s, in parts of the width of the MV's hard limits
  Distribution time_constant = Distribution::constant(0.0);  ///< samples; 0: white
  /// The largest size of s over the smallest along a record, drawn once a world: s goes with
  /// swell^(sin(2 pi k / N + phase) / 2), the phase drawn in each loop anew.
  Distribution swell = Distribution::constant(1.0);

  bool operator==(const BackgroundRanges&) const = default;
};

/// The distributions of the worlds of a study ([world] of a study file). In a world every channel of the
/// plant differs a little from the model, small disturbances never stop, and the benchmark is a record of
/// this plant. The controller and the methods know only the model and the benchmark. Every
/// number is drawn for each channel, CV or MV by itself.
struct WorldRanges {
  int count = 8;  ///< worlds, over which the experiments of each kind are spread evenly
  Distribution gain_factor = Distribution::constant(1.0);
  Distribution time_constant_factor = Distribution::constant(1.0);
  Distribution dead_time_factor = Distribution::constant(1.0);
  /// Added to the dead time, in the time unit of the plant; the resulting dead time is at least 0.
  Distribution dead_time_shift = Distribution::constant(0.0);
  /// Time constant of a further lag, over the residence time of the channel.
  Distribution extra_lag = Distribution::constant(0.0);
  Distribution noise_factor = Distribution::constant(1.0);  ///< of the noise of each CV
  /// c of the characteristic of each valve: with hard limits a and b of its MV the plant gets
  /// u + c (u - a) (b - u) / (b - a), less the same term where the loop starts. The gain of the MV goes from
  /// 1 + c to 1 - c between its limits, and no model has that.
  Distribution valve_curvature = Distribution::constant(0.0);
  std::vector<WorldParameter> plant_parameters = {};  ///< of a nonlinear plant, instead of channels
  BackgroundRanges background = {};
  int cost_loops = 8;  ///< pairs of loops over whose noise the cost of a fault is an expectation
  /// Loops over whose noise the gain of repairing a channel is an expectation; 0: it is not computed.
  int repair_loops = 4;
  /// A channel whose gain in the first of these loops is below this share of the largest one gets no further
  /// loops; 0: all run.
  double repair_screen = 0.0;

  bool operator==(const WorldRanges&) const = default;
};

}  // namespace mpm
