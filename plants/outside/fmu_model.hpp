#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "plants/nonlinear/foreign_model.hpp"

namespace mpm {

/// A functional mock-up unit as the plant of a study: its file, and the roles of its variables.
struct FmuSettings {
  /// A variable of the FMU.
  struct Variable {
    std::string name;
    std::string place;  ///< where the study names it, for messages
  };

  std::filesystem::path file;
  std::string place;         ///< where the study names it, for messages
  double time_factor = 1.0;  ///< time units of the FMU (usually s) in one time unit of the study
  double step = 0.0;         ///< longest communication step, in the time of the FMU; 0: one sample
  std::vector<Variable> inputs, outputs, parameters;
};

/// A plant by FMI 2.0 or 3.0, for co-simulation or model exchange. A sample is one communication step with
/// held inputs, or several if FmuSettings::step is shorter.
///
/// Each simulation runs in its own process (ForkedService), with one instance in it: many exports allow no
/// more. Neither a crash nor what an FMU keeps in memory can then reach another loop. load() unpacks the file
/// into a temporary folder that is removed with the model; it also says what is wrong with the FMU or the
/// names in the study.
std::shared_ptr<const ForeignModel> fmu_model(FmuSettings settings, const ForeignOptions& options);

}  // namespace mpm
