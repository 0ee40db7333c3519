#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/nonlinear/nonlinear_model.hpp"

// What can be wrong in an experiment: mismatches of the plant, and disturbances that nobody measures.

namespace mpm {

/// What is wrong in an experiment. `healthy`: nothing, as in the basis case; there is only noise. `tuning`:
/// model and plant agree, but a weight of the controller is changed. `other`: there is a fault outside of the
/// model, see OtherFault.
enum class ExperimentKind : std::int8_t { healthy = 0, mpm = 1, ud = 2, mpm_ud = 3, tuning = 4, other = 5 };

template <>
inline constexpr auto kWords<ExperimentKind> = word_list("healthy", "mpm", "ud", "mpm_ud", "tuning", "other");

/// Has the loop no mismatch, no disturbance and no other fault? Every verdict of a modelling error is then a
/// false alarm.
inline bool is_faultless(ExperimentKind kind) {
  return kind == ExperimentKind::healthy || kind == ExperimentKind::tuning;
}

/// The source of a fault, as a method names it or as it affects a CV: a mismatch, a disturbance, both, or
/// another fault.
enum class FaultSource : std::int8_t { none = 0, mpm = 1, ud = 2, mpm_ud = 3, other = 4 };

/// The source of the faults of an experiment of this kind; `none` for `healthy` and `tuning`.
FaultSource source_of(ExperimentKind kind);

template <>
inline constexpr auto kWords<FaultSource> = word_list("none", "mpm", "ud", "mpm_ud", "other");

/// The parameter of a channel that a model-plant mismatch changes, as in table 6.4, or the dynamics that it
/// adds.
enum class MismatchParameter : std::int8_t {
  gain = 0,
  time_constant = 1,
  dead_time = 2,
  channel = 3,           ///< the channel of the plant has another transfer function, as in (4.19) to (4.21)
  second_order = 4,      ///< the plant has a further lag: G / (value s + 1)
  inverse_response = 5,  ///< the plant first moves in the wrong direction: G (1 - value s) / (1 + value s)
  sign = 6,              ///< the gain of the plant has the opposite sign: value = -1
};

template <>
inline constexpr auto kWords<MismatchParameter> = word_list("gain", "time_constant", "dead_time", "channel",
                                                            "second_order", "inverse_response", "sign");

/// A model-plant mismatch: the channel (cv, input) of the plant differs from the model.
struct Mismatch {
  Eigen::Index cv;
  Eigen::Index input;  ///< column of G: first the MVs, then the MDs (a mismatch of the feed-forward)
  MismatchParameter parameter;
  double value;  ///< factor of gain or time constant; shift of the dead time, or time constant of the added
                 ///< dynamics, in the plant's time unit
  std::optional<TransferFunction> channel = {};  ///< that of the plant if the parameter is `channel`

  friend bool operator==(const Mismatch& a, const Mismatch& b);
};

/// Applies these mismatches to `model`, one after the other, and returns the plant. Errors: InputError for a
/// channel outside of the matrix, and those of the `with_` functions of TransferFunction.
TransferMatrix with_mismatches(TransferMatrix model, const std::vector<Mismatch>& mismatches);

/// White normal numbers, each held for `hold` samples. Their standard deviation is factor *
/// disturbance.v_standard_deviation of the study.
struct WhiteNoise {
  double factor = 1.0;
  int hold = 1;

  bool operator==(const WhiteNoise&) const = default;
};

/// amplitude sin(2 pi t / period).
struct Sine {
  double amplitude;
  double period;  ///< time unit of the plant

  bool operator==(const Sine&) const = default;
};

/// slope (t - start) from t = start on, 0 before it.
struct Ramp {
  double slope;  ///< per time unit of the plant
  double start;  ///< time unit of the plant

  bool operator==(const Ramp&) const = default;
};

/// 0 before the first step; each step sets its `level` from its `sample` on.
struct StepSequence {
  struct Step {
    int sample;
    double level;

    bool operator==(const Step&) const = default;
  };
  std::vector<Step> steps;  ///< in the order of their samples

  bool operator==(const StepSequence&) const = default;
};

/// v(k) = v(k - 1) + a white normal number with the standard deviation factor *
/// disturbance.v_standard_deviation; v(0) = 0.
struct RandomWalk {
  double factor = 1.0;

  bool operator==(const RandomWalk&) const = default;
};

/// White noise in bursts, and 0 between them. After each sample of a burst, the burst ends with probability
/// 1 / length; after each silent sample, a burst begins with probability 1 / pause.
struct Bursts {
  double factor = 1.0;
  double length = 20.0;  ///< mean length of a burst, samples
  double pause = 80.0;   ///< mean pause between bursts, samples

  bool operator==(const Bursts&) const = default;
};

using DisturbanceSignal = std::variant<WhiteNoise, Sine, Ramp, StepSequence, RandomWalk, Bursts>;

/// The signal times a factor.
DisturbanceSignal scaled(DisturbanceSignal signal, double factor);

/// The transfer function from the signal v of a disturbance to the CV.
enum class DisturbanceModel : std::int8_t {
  first_order = 0,        ///< G_d = gain / (time_constant s + 1)
  transfer_function = 1,  ///< any G_d; it may integrate
  direct = 2,             ///< no G_d: y_d = v, which is not held over a sample
};

/// An unmeasured disturbance y_d = G_d v added to one CV, to an MV between controller and plant, or to an
/// inner input of a nonlinear plant.
struct Disturbance {
  Eigen::Index cv;       ///< -1: the disturbance is not on a CV
  double gain;           ///< of a first-order G_d, CV unit per unit of v
  double time_constant;  ///< of a first-order G_d, time unit of the plant
  DisturbanceModel model = DisturbanceModel::first_order;
  std::optional<TransferFunction> Gd = {};  ///< if the model is `transfer_function`
  DisturbanceSignal signal = WhiteNoise{};
  std::optional<Eigen::Index> inner_input = {};  ///< place in NonlinearModel::inner_inputs
  std::optional<Eigen::Index> mv = {};           ///< added to this MV on its way to the plant
  bool shares_signal = false;  ///< uses the v of the first disturbance of the experiment, not its own

  /// Is it added to the output of the plant?
  bool is_on_cv() const { return !inner_input && !mv; }

  friend bool operator==(const Disturbance& a, const Disturbance& b);
};

/// When the faults of an experiment begin. Their share is 0 before `sample` and 1 from `sample + growth` on;
/// it grows linearly in between.
struct Onset {
  int sample = 0;
  int growth = 0;  ///< samples; 0: a step

  double share(Eigen::Index k) const {
    return k < sample ? 0.0 : k >= sample + growth ? 1.0 : static_cast<double>(k - sample) / growth;
  }
  bool from_the_start() const { return sample == 0 && growth == 0; }

  bool operator==(const Onset&) const = default;
};

/// The kind of an experiment with these faults; changed parameters count as a mismatch.
ExperimentKind kind_of(const std::vector<Mismatch>& mismatches,
                       const std::vector<ParameterChange>& parameters,
                       const std::vector<Disturbance>& disturbances);

/// An experiment that a study specifies in full, such as those of table 6.3.
struct Scenario {
  std::string name;
  std::string description;  ///< for people; may be empty
  std::vector<Mismatch> mismatches;
  std::vector<Disturbance> disturbances;
  /// The CVs that a diagnosis should find (default: those with a fault).
  std::optional<std::vector<Eigen::Index>> affected_cvs;
  std::vector<ParameterChange> parameters = {};  ///< mismatches of a nonlinear plant

  bool operator==(const Scenario&) const = default;
};

}  // namespace mpm
