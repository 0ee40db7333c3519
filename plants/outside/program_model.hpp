#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/foreign_model.hpp"

namespace mpm {

/// A program as the plant of a study.
struct ProgramSettings {
  std::vector<std::string> command;                       ///< the program and its arguments
  std::vector<std::string> parameters;                    ///< names
  Eigen::Index mvs = 0, mds = 0, inner = 0, outputs = 0;  ///< numbers of them
};

/// A plant that answers lines of JSON with lines of JSON (docs/own_plant.md):
///
///   {"call": "reset", "parameters": {"NAME": value, ...}, "sample_time": Ts}   ->   {}
///   {"call": "step", "u": [...], "d": [...], "inner": [...]}                   ->   {"y": [...]}
///
/// Each simulation runs its own program; a reset starts from the beginning. Parameters are fixed: they come
/// with the reset. Errors of a simulation, besides those of ChildProcess: an answer of another form, and
/// {"error": TEXT}.
std::shared_ptr<const ForeignModel> program_model(ProgramSettings settings, const ForeignOptions& options);

}  // namespace mpm
