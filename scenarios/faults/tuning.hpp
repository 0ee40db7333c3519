#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "scenarios/random/distribution.hpp"
#include "solvers/mpc_options.hpp"

// Experiments with a bad tuning: the model is right and nothing disturbs the plant, but one weight of the
// controller is not what it should be. An assessment of the model should not call that a modelling error.

namespace mpm {

/// The weight of the controller that is changed; it belongs to an MV or a CV.
enum class TuningParameter : std::int8_t {
  move_suppression = 0,  ///< of an MV
  target_weight = 1,     ///< of an MV with a target
  slack_weight = 2,      ///< of a CV with a soft limit
  setpoint_weight = 3,   ///< of a CV with a setpoint
};

/// Each word is the name of the member of MpcOptions.
template <>
inline constexpr auto kWords<TuningParameter> = word_list("move_suppression", "target_weight", "slack_weight",
                                                          "setpoint_weight");
inline constexpr auto kTuningParameters = enumerators<TuningParameter>();

/// Is it a weight of an MV? Otherwise it is one of a CV.
bool is_of_mv(TuningParameter parameter);

/// One weight of the controller times a factor.
struct TuningChange {
  TuningParameter parameter;
  Eigen::Index index;  ///< of the MV or CV
  double factor;       ///< > 0; multiplies the weight as the study writes it, whatever weight_convention says

  bool operator==(const TuningChange&) const = default;
};

/// The MVs or CVs that have this weight in the controller.
std::vector<Eigen::Index> variables_with(const MpcOptions& controller, TuningParameter parameter);

/// The controller with the change. Errors: InputError for a variable without the weight, or a factor that is
/// not a finite number > 0.
MpcOptions with_tuning(MpcOptions controller, const TuningChange& change);

/// The controller whose S0 is used in an experiment with a bad tuning.
enum class TuningSensitivity : std::int8_t {
  current = 0,  ///< the controller that runs: S0 is determined anew after a change of tuning (appendix A2)
  design = 1,   ///< the controller of the study: nobody noticed the change
};

/// Ranges of the random changes of the tuning.
struct TuningRanges {
  /// Relative frequency of each parameter, in the order of TuningParameter. A parameter that the controller
  /// does not have is never drawn.
  std::array<double, 4> parameter_weight{1.0, 1.0, 1.0, 1.0};
  Distribution factor = Distribution::log_uniform(0.05, 20.0);
  TuningSensitivity sensitivity = TuningSensitivity::current;

  /// Relative frequencies with 0 for the parameters that the controller does not have.
  std::array<double, 4> weights_for(const MpcOptions& controller) const;

  bool operator==(const TuningRanges&) const = default;
};

}  // namespace mpm
