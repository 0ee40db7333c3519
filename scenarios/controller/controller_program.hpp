#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "solvers/controller.hpp"

namespace mpm {

class ControllerTalks;

/// A program as the controller of a study: it answers lines of JSON (docs/own_plant.md).
///
///   {"call": "describe"}                                        ->  {"on_model": true}
///   {"call": "context", ...}                                    ->  {}
///   {"call": "reset", "u": [...], "d": [...], "y": [...]}       ->  {}
///   {"call": "step", "y", "d", "u", "y_set", "cv_soft"}         ->  {"u": [...], "u_target": [...]}
///
/// each with the number of the message (ProgramTalk). While variables are off, a step has "mv_off" and
/// "cv_off" as well, and the answer for an MV that is off is not used. Copies share their programs: in one
/// process, each controller that is at work at the same time has a program of its own, and idle programs wait
/// for the next loop.
class ControllerProgram {
 public:
  ControllerProgram(std::vector<std::string> command, double time_limit);

  const std::vector<std::string>& command() const;

  /// Does the program run on the nominal model too, with the limits and setpoints from which S0 follows? If
  /// not, it runs only on the plant of the study. Starts the program if this is not known yet. Errors:
  /// InputError if it gives no description.
  bool runs_on_model() const;

  /// A controller of `plant` with this tuning, which receives unit step responses of `samples` samples. A
  /// failure of the program becomes ControlStatus::failed; a failure of its surroundings
  /// (is_of_surroundings()) is thrown. nominal_target() is that of Mpc, with a solver from `factory`; the
  /// answers of the program are limited to the hard limits of the MVs.
  std::unique_ptr<Controller> controller(const PlantModel& plant, const MpcOptions& options,
                                         Eigen::Index samples, const QpSolverFactory& factory) const;

  /// The same program: the same command, with the same time to answer.
  friend bool operator==(const ControllerProgram& a, const ControllerProgram& b);

 private:
  std::shared_ptr<ControllerTalks> talks_;
};

}  // namespace mpm
