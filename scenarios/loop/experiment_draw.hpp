#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The number of the world without errors of the model and without background (scenarios/loop/world.hpp). The
/// loops of a study without [world] are in this world, and so is the nominal loop of every study.
inline constexpr int kExactWorld = -1;

/// A CV that an experiment affects, and the fault that affects it.
struct AffectedCv {
  Eigen::Index cv;
  FaultSource by;  ///< mpm, ud, or mpm_ud for both; none: another fault
};

/// How much larger the faults of an experiment are than drawn, in a study that asks for faults of a given
/// effect.
///
/// | member      | of                                  | what becomes of the drawn value x        |
/// |-------------|-------------------------------------|------------------------------------------|
/// | mismatch    | factors of gain, time constant and plant parameters | x^scale; that of a sign stays |
/// |             | shifts of the dead time, further lags, inverse responses | scale x          |
/// | disturbance | gain of G_d                         | scale x                                  |
/// | other       | OtherFault::size and jump           | scale x; the factor of an MD: x^scale    |
struct FaultScales {
  double mismatch = 1.0;
  double disturbance = 1.0;
  double other = 1.0;

  bool operator==(const FaultScales&) const = default;
};

/// What one experiment does to the loop: drawn at random, with a mismatch, a disturbance, both, another fault
/// or a change of the tuning, or a named scenario of the study. A mismatch may change several channels and a
/// disturbance may act on several CVs (MismatchExtent, DisturbancePlace).
struct ExperimentDraw {
  std::int64_t index = 0;
  ExperimentKind kind = ExperimentKind::healthy;
  std::vector<Mismatch> mismatches;
  std::vector<Disturbance> disturbances;
  bool named = false;  ///< it is scenario `index` of the study
  /// The CVs that a diagnosis should find, if the study names them; otherwise those with a fault.
  std::optional<std::vector<Eigen::Index>> affected_cvs = {};
  std::vector<ParameterChange> parameters = {};  ///< changed in a nonlinear plant; they count as a mismatch
  std::optional<TuningChange> tuning = {};       ///< of the controller; no fault of model or plant
  std::optional<OtherFault> other = {};          ///< outside of the model, which is right
  Onset onset = {};                              ///< of all faults except the tuning
  FaultScales scales = {};                       ///< by which the sizes above were scaled
  double noise_factor = 1.0;  ///< of the measurement noise (NoiseOptions::factor); no fault either
  /// The index whose noise and background the loop has instead of its own; for loops of one experiment that
  /// differ in nothing else.
  std::optional<std::int64_t> noise_index = {};
  int world = kExactWorld;  ///< in which the experiment takes place

  /// The affected CVs, in their order. A CV without a fault of its own is affected by all faults of the
  /// experiment.
  std::vector<AffectedCv> affected() const;
  /// The affected CV; -1 if there is none, or more than one.
  Eigen::Index true_cv() const;
  /// The same experiment with the mismatches alone, and with the disturbances alone.
  ExperimentDraw mismatch_alone() const;
  ExperimentDraw disturbance_alone() const;
  /// The same loop under the same noise, without any fault.
  ExperimentDraw without_faults() const;
};

/// The index under which the basis case draws its noise: no experiment of a study has it.
inline constexpr std::int64_t kBasisIndex = -1;
/// The index of the basis case with other noise (SelfCheck::repeat).
inline constexpr std::int64_t kRepeatIndex = -2;
/// The index under which a sequence that all experiments share is drawn (SignalSequence::shared).
inline constexpr std::int64_t kSharedIndex = -3;

/// The index under which the benchmark of a world draws its noise; kBasisIndex for the exact world.
constexpr std::int64_t basis_index(int world) {
  return world == kExactWorld ? kBasisIndex : kSharedIndex - 1 - world;
}

/// The index under which a benchmark that belongs to experiment `index` alone is drawn: below all others.
constexpr std::int64_t own_benchmark_index(std::int64_t index) {
  return -(std::int64_t{1} << 50) - index;
}

}  // namespace mpm
