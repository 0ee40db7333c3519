#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/foreign_model.hpp"
#include "plants/nonlinear/ode_system.hpp"

namespace mpm {

/// A parameter of a nonlinear plant that has another value than in the model of the controller.
struct ParameterChange {
  std::string name;
  double value;  ///< in the unit of the parameter

  bool operator==(const ParameterChange&) const = default;
};

/// The nonlinear plant behind a linear model: equations of ours, or the simulation of somebody else.
///
/// Its inputs are the MVs and the MDs of the linear model, in their order, and then the inner inputs, where
/// only disturbances act. Its outputs are the CVs. Its states mean the same whatever its parameters are.
struct NonlinearModel {
  /// A parameter with the value that the linear model rests on.
  struct Parameter {
    std::string name;
    double nominal;

    bool operator==(const Parameter&) const = default;
  };

  std::vector<Parameter> parameters;
  std::vector<std::string> inner_inputs;  ///< names
  Eigen::VectorXd operating_input;        ///< where it was linearised; all inputs
  /// The equations with these parameters changed. Errors: InputError for a name that is not among
  /// `parameters`, or a value out of range.
  std::function<std::shared_ptr<const OdeSystem>(const std::vector<ParameterChange>&)> make_system;
  std::shared_ptr<const ForeignModel> foreign = {};  ///< instead of make_system

  /// Does nothing when the plant can have these parameters. Errors: InputError as make_system; what somebody
  /// else's simulation refuses shows only when it runs.
  void check(const std::vector<ParameterChange>& changes) const;

  /// Without the equations, which cannot be compared.
  friend bool operator==(const NonlinearModel& a, const NonlinearModel& b);
};

/// The same plant, which has always had these parameters: they are its nominal ones, and its operating point
/// is its own steady state under `operating_input`. Errors: InputError as make_system.
NonlinearModel with_parameters(NonlinearModel model, const std::vector<ParameterChange>& changes);

}  // namespace mpm
