#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "plants/nonlinear/foreign_model.hpp"

namespace mpm {

/// A functional mock-up unit as the plant of a study: which file, and which of its variables are what.
struct FmuSettings {
  /// A variable of the FMU.
  struct Variable {
    std::string name;
    std::string place;  ///< where the study names it, for messages
  };

  std::filesystem::path file;
  std::string place;         ///< where the study names it, for messages
  double time_factor = 1.0;  ///< units of the time of the FMU, as a rule s, in one of the study
  double step = 0.0;         ///< longest communication step, time of the FMU; 0: a sample
  std::vector<Variable> inputs, outputs, parameters;
};

/// A plant by FMI 2.0 or 3.0, for co-simulation or model exchange. A sample is one communication step with
/// held inputs, or as many as FmuSettings::step makes of it.
///
/// Each simulation runs in a process of its own (ForkedService), with one instance in it: many exports allow
/// no more, and so neither a crash nor what an FMU keeps in memory reaches another loop. load() unpacks the
/// file into a temporary folder that is removed with the model; it also says what is wrong with the FMU or
/// the names of the study.
std::shared_ptr<const ForeignModel> fmu_model(FmuSettings settings, const ForeignOptions& options);

}  // namespace mpm
