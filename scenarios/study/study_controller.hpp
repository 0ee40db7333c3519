#pragma once

#include <memory>

#include "scenarios/study/study.hpp"
#include "solvers/controller.hpp"

namespace mpm {

/// The controller of the study on its model, with this tuning instead of the study's: the built-in one,
/// whose solvers `factory` makes, or its program. Throws InputError when the tuning does not fit the model.
std::unique_ptr<Controller> controller_of(const Study& study, const MpcOptions& tuning,
                                          const QpSolverFactory& factory);

/// Can the controller be run on its own model? Only then there is an S0, and a nominal loop. Errors:
/// InputError as ControllerProgram::runs_on_model().
bool runs_on_model(const Study& study);

}  // namespace mpm
