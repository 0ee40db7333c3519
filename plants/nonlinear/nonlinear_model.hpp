#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/foreign_model.hpp"
#include "plants/nonlinear/ode_system.hpp"

namespace mpm {

/// A parameter of a nonlinear plant whose value differs from that in the model of the controller.
struct ParameterChange {
  std::string name;
  double value;  ///< in the unit of the parameter

  bool operator==(const ParameterChange&) const = default;
};

/// The nonlinear plant behind a linear model: equations of ours, or the simulation of somebody else.
///
/// Its inputs are the MVs and the MDs of the linear model, in their order, and then the inner inputs, where
/// only disturbances act. Its outputs are the CVs. Its states have the same meaning for all values of its
/// parameters.
struct NonlinearModel {
  /// A parameter with the value on which the linear model is based.
  struct Parameter {
    std::string name;
    double nominal;

    bool operator==(const Parameter&) const = default;
  };

  std::vector<Parameter> parameters;
  std::vector<std::string> inner_inputs;  ///< names
  Eigen::VectorXd operating_input;        ///< all inputs, at the point of linearisation
  /// Makes the equations with these parameters changed. Errors: InputError for a name that is not among
  /// `parameters`, or a value out of range.
  std::function<std::shared_ptr<const OdeSystem>(const std::vector<ParameterChange>&)> make_system;
  std::shared_ptr<const ForeignModel> foreign = {};  ///< instead of make_system

  /// Checks that the plant can have these parameters. Errors: InputError as make_system. A foreign simulation
  /// can refuse values only when it runs.
  void check(const std::vector<ParameterChange>& changes) const;

  /// Compares all but the equations, which cannot be compared.
  friend bool operator==(const NonlinearModel& a, const NonlinearModel& b);
};

/// Returns the same plant as if it had always had these parameters: they are its nominal ones, and its
/// operating point is its own steady state under `operating_input`. Errors: InputError as make_system.
NonlinearModel with_parameters(NonlinearModel model, const std::vector<ParameterChange>& changes);

}  // namespace mpm
