#pragma once

#include "scenarios/random/distribution.hpp"

namespace mpm {

/// What a reader of the record finds where a sample is missing.
enum class GapFill {
  none,    ///< nothing: NaN
  hold,    ///< the last value before the gap
  linear,  ///< the straight line between the values on both sides of the gap
};

/// What the historian makes of the measured CVs that it keeps (historian.hpp). As it is: every sample, as it
/// was measured. The sizes are in standard deviations of the measurement noise of the CV
/// (SimulationOptions::noise_standard_deviation), to which ranges and resolutions of transmitters are chosen.
struct RecordOptions {
  static constexpr int kMostCandidates = 9;  ///< each has a stream of its own

  double outlier_share = 0.0;                              ///< of the samples of each CV, drawn one by one
  Distribution outlier_size = Distribution::constant(10);  ///< added, with either sign
  double quantisation = 0.0;                               ///< step between two values; 0: none
  double missing_share = 0.0;                              ///< of the samples of each CV, in the long run
  double missing_length = 1.0;                             ///< mean length of a gap, samples
  GapFill fill = GapFill::none;
  double compression = 0.0;      ///< deviation that the historian allows itself; 0: it keeps every sample
  int candidates = 0;            ///< further signals that it keeps (logged_candidates)
  double candidate_share = 0.5;  ///< of the disturbed loops in which one of them drives the disturbance

  /// Does the historian keep anything else than what was measured?
  bool alters() const {
    return outlier_share > 0.0 || quantisation > 0.0 || missing_share > 0.0 || compression > 0.0;
  }

  bool operator==(const RecordOptions&) const = default;
};

}  // namespace mpm
