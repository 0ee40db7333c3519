#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear_model.hpp"
#include "plants/transfer_matrix.hpp"

// What can be wrong in an experiment: mismatches of the plant, and disturbances that nobody measures.

namespace mpm {

/// What is wrong in an experiment. Nothing is in a `healthy` one, the basis case among them: there is only
/// noise. In one of the kind `tuning` model and plant agree, and a weight of the controller is changed.
enum class ExperimentKind : std::int8_t { healthy = 0, mpm = 1, ud = 2, mpm_ud = 3, tuning = 4 };

/// "healthy", "mpm", "ud", "mpm_ud", "tuning"
std::string_view to_string(ExperimentKind kind);

/// Is there neither mismatch nor disturbance, so that every verdict of a modelling error is a false alarm?
inline bool is_faultless(ExperimentKind kind) {
  return kind == ExperimentKind::healthy || kind == ExperimentKind::tuning;
}

/// What a method sees as the cause of a fault, and what affects a CV: a mismatch, a disturbance, or both.
enum class FaultSource : std::int8_t { none = 0, mpm = 1, ud = 2, mpm_ud = 3 };

/// The source of the faults of an experiment of this kind; none where model and plant agree.
FaultSource source_of(ExperimentKind kind);

/// "none", "mpm", "ud", "mpm_ud"
std::string_view to_string(FaultSource source);

/// Which parameter of a channel a model-plant mismatch changes, as in table 6.4; `channel`: the plant has
/// another transfer function in this place, as in (4.19) to (4.21).
enum class MismatchParameter : std::int8_t { gain = 0, time_constant = 1, dead_time = 2, channel = 3 };

/// "gain", "time_constant", "dead_time", "channel"
std::string_view to_string(MismatchParameter parameter);

/// A model-plant mismatch: the channel (cv, input) of the plant differs from the model.
struct Mismatch {
  Eigen::Index cv;
  Eigen::Index input;  ///< column of G: an MV, or after them an MD (a mismatch of the feed-forward)
  MismatchParameter parameter;
  double value;  ///< factor of gain or time constant; shift of the dead time in the plant's time unit
  std::optional<TransferFunction> channel = {};  ///< of the plant, when the parameter is `channel`

  friend bool operator==(const Mismatch& a, const Mismatch& b);
};

/// The plant that has these mismatches, one after the other, where the model is `model`. Errors: InputError
/// for a channel outside of the matrix, or as the `with_` functions of TransferFunction.
TransferMatrix with_mismatches(TransferMatrix model, const std::vector<Mismatch>& mismatches);

/// White normal numbers, each held for `hold` samples, of the standard deviation factor *
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

/// 0 at first, and `level` from `sample` on.
struct StepSequence {
  struct Step {
    int sample;
    double level;

    bool operator==(const Step&) const = default;
  };
  std::vector<Step> steps;  ///< in the order of their samples

  bool operator==(const StepSequence&) const = default;
};

using DisturbanceSignal = std::variant<WhiteNoise, Sine, Ramp, StepSequence>;

/// What stands between the signal v of a disturbance and the CV.
enum class DisturbanceModel : std::int8_t {
  first_order = 0,        ///< G_d = gain / (time_constant s + 1)
  transfer_function = 1,  ///< any G_d; it may integrate
  direct = 2,             ///< nothing: y_d = v, without the hold of a sample
};

/// An unmeasured disturbance y_d = G_d v added to one CV, or to an inner input of a nonlinear plant.
struct Disturbance {
  Eigen::Index cv;       ///< -1 for one of an inner input
  double gain;           ///< CV unit per unit of v; of a first-order G_d
  double time_constant;  ///< time unit of the plant; of a first-order G_d
  DisturbanceModel model = DisturbanceModel::first_order;
  std::optional<TransferFunction> Gd = {};  ///< when the model is `transfer_function`
  DisturbanceSignal signal = WhiteNoise{};
  std::optional<Eigen::Index> inner_input = {};  ///< place in NonlinearModel::inner_inputs

  friend bool operator==(const Disturbance& a, const Disturbance& b);
};

/// The kind of an experiment with these faults; changed parameters are a mismatch.
ExperimentKind kind_of(const std::vector<Mismatch>& mismatches,
                       const std::vector<ParameterChange>& parameters,
                       const std::vector<Disturbance>& disturbances);

/// An experiment that a study spells out, such as those of table 6.3.
struct Scenario {
  std::string name;
  std::string description;  ///< for people; may be empty
  std::vector<Mismatch> mismatches;
  std::vector<Disturbance> disturbances;
  /// The CVs that a diagnosis should find; none given: those with a fault.
  std::optional<std::vector<Eigen::Index>> affected_cvs;
  std::vector<ParameterChange> parameters = {};  ///< mismatches of a nonlinear plant

  bool operator==(const Scenario&) const = default;
};

}  // namespace mpm
